// Draws pictures of the shipped scenes for the documentation, each into its own file in the given folder.
//
//    bin/draw_looks FOLDER [dark_room | bump_plane | looks | reflecting | stereo | questions]... [--samples N]
#include <cmath>
#include <cstdio>
#include <iostream>
#include <numbers>
#include <tactus/question_t.hpp>
#include <tactus/scene_t.hpp>

#include "sync/node/node_options.h"
#include "tests/visual_node/golden/shipped_scene.h"
#include "visual_node/overlay/question_panel.h"
#include "visual_node/video/png.h"

using namespace tactus;
using test::Picture;
using test::ShippedScene;

namespace {

visual::Settings sized(int width, int height, int samples) {
  visual::Settings settings;
  settings.width = width, settings.height = height, settings.anti_aliasing = samples;
  settings.shadow_size = 1024;  // still pictures are viewed longer than frames
  return settings;
}

ShippedScene load(const std::string& name) {
  return ShippedScene(TACTUS_SOURCE_DIR "/sim_node/scenes/" + name + ".sdf");
}

// Joins pictures of one size from left to right.
Picture side_by_side(const std::vector<Picture>& parts) {
  Picture all{0, parts.front().height, {}};
  for (const Picture& p : parts) all.width += p.width;
  all.rgba.resize(static_cast<std::size_t>(4 * all.width * all.height));
  int x = 0;
  for (const Picture& p : parts) {
    for (int y = 0; y < p.height; ++y)
      std::copy_n(&p.rgba[static_cast<std::size_t>(4 * y * p.width)], 4 * p.width,
                  &all.rgba[static_cast<std::size_t>(4 * (y * all.width + x))]);
    x += p.width;
  }
  return all;
}

// Averages pairs of rows as bytes, which is accurate enough because the two rows differ little.
Picture half_height(const Picture& from) {
  Picture to{from.width, from.height / 2, {}};
  const auto row = static_cast<std::size_t>(4 * from.width);
  for (std::size_t i = 0; i < row * static_cast<std::size_t>(to.height); ++i) {
    const std::size_t upper = i / row * 2 * row + i % row;
    to.rgba.push_back(static_cast<std::uint8_t>((from.rgba[upper] + from.rgba[upper + row]) / 2));
  }
  return to;
}

// Throws if a part of the scene could not be drawn as specified.
Picture checked(const ShippedScene& from, Picture picture) {
  if (!from.warnings.empty()) throw std::runtime_error(from.warnings.front());
  return picture;
}

Picture dark_room(int samples) {
  ShippedScene s = load("dark_room");
  Picture picture = s.draw(s.scene, sized(800, 600, samples));
  return checked(s, std::move(picture));
}

// The boards from above, the deepest relief at the lower end, in grazing light from the left, from above, from the right and from below.
Picture bump_plane(int samples) {
  ShippedScene s = load("bump_plane");
  scene_t scene = s.scene;
  // The view is down, the picture's up is +y.
  Eigen::Matrix3d axes;
  axes << -Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY();
  scene.camera = to_pose(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1.2) * Eigen::Quaterniond(axes)));
  scene.camera_fov_rad = 2 * std::atan(0.195 / 1.2);
  std::vector<Picture> parts;
  for (const double azimuth_deg : {180.0, 90.0, 0.0, -90.0}) {
    const double a = azimuth_deg * std::numbers::pi / 180;
    const Eigen::Vector3d lamp(0.8 * std::cos(a), 0.8 * std::sin(a), 0.35);
    scene.lights[0].pose.position_m = to_vec3(lamp);
    scene.lights[0].direction = to_vec3(Eigen::Vector3d(-lamp.normalized()));
    parts.push_back(s.draw(scene, sized(180, 300, samples)));
  }
  return checked(s, side_by_side(parts));
}

Picture looks(int samples) {
  ShippedScene s = load("looks_bench");
  scene_t scene = s.scene;
  scene.camera = test::look_at({-1.4, 0, 0.4}, {0, 0, 0.04});
  scene.camera_fov_rad = 0.76;
  Picture picture = s.draw(scene, sized(1200, 250, samples));
  return checked(s, std::move(picture));
}

// The mirror and the glass of looks_bench from close by.
Picture reflecting(int samples) {
  ShippedScene s = load("looks_bench");
  scene_t scene = s.scene;
  scene.camera = test::look_at({-0.26, -0.13, 0.13}, {0, -0.13, 0.05});
  scene.camera_fov_rad = 1;
  Picture picture = s.draw(scene, sized(640, 360, samples));
  return checked(s, std::move(picture));
}

// The left eye's picture on the left, for parallel free viewing. Both are squeezed for a display that stretches them; the height is
// reduced here to match.
Picture stereo(int samples) {
  ShippedScene s = load("dark_room");
  visual::Settings settings = sized(1000, 800, samples);
  settings.stereo = std::string("side_by_side");
  settings.stereo_distance_m = 1.2;
  Picture picture = s.draw(s.scene, settings);
  return checked(s, half_height(picture));
}

// A question to the participant of a study, above the cells of the marker.
Picture requested(const question_t& m, double number, int width, int height, int samples) {
  constexpr float kMarker_px = 48;
  ShippedScene s = load("dark_room");
  std::vector<visual::Rect> overlay;
  visual::append_question(overlay, m, number,
                          {0, 0, static_cast<float>(width), static_cast<float>(height) - kMarker_px});
  Picture picture = s.draw(s.scene, sized(width, height, samples), overlay);
  return checked(s, std::move(picture));
}

Picture questions(int samples) {
  question_t choice{}, number{};
  choice.kind = question_t::CHOICE;
  choice.text = "Did you hear the ball and see it touch the floor at the same time?";
  choice.choices = {"at the same time", "not at the same time", "I do not know"};
  choice.count = static_cast<std::int32_t>(choice.choices.size());
  number.kind = question_t::NUMBER;
  number.text = "How hard was the ball that you pressed?";
  number.choices = {"as soft as a sponge", "as hard as stone"};
  number.count = 2;
  number.lowest = 0, number.highest = 100, number.step = 1;
  choice.progress = number.progress = "block 1 of 4, 12 of 60";
  return side_by_side({requested(choice, 0, 640, 480, samples), requested(number, 64, 640, 480, samples)});
}

}  // namespace

int main(int argc, char** argv) try {
  const std::vector<std::pair<std::string, Picture (*)(int)>> all{
      {"dark_room", dark_room},   {"bump_plane", bump_plane}, {"looks", looks},
      {"reflecting", reflecting}, {"stereo", stereo},         {"questions", questions}};
  std::string folder;
  std::vector<std::string> wanted;
  int samples = 4;
  tactus::sync::Arguments app("Draws pictures of the shipped scenes for the documents.");
  app.add_option("FOLDER", folder, "folder of the PNG files").required().existing_folder();
  app.add_option("PICTURE", wanted, "pictures to draw; default: all")
      .one_of({"dark_room", "bump_plane", "looks", "reflecting", "stereo", "questions"});
  app.add_option("--samples", samples, "a pixel").range(1, 16).show_default();
  tactus::sync::parse_or_exit(app, "draw_looks", argc, argv);
  for (const auto& [name, draw] : all) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) continue;
    const Picture picture = draw(samples);
    const std::string file = folder + "/" + name + ".png";
    if (!visual::write_png(file, picture.rgba, picture.width, picture.height))
      throw std::runtime_error("cannot write " + file);
    std::printf("%s, %d x %d\n", file.c_str(), picture.width, picture.height);
  }
  return 0;
} catch (const std::exception& e) {
  std::cerr << "draw_looks: " << e.what() << "\n";
  return 1;
}
