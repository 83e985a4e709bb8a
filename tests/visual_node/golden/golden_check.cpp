// Small pictures of the shipped scenes, compared perceptually with stored pictures that were inspected.
//
// To accept an intended change: bin/visual_golden_test "[rewrite]", then inspect the changed pictures.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <tactus/body_def_t.hpp>
#include <tactus/look_t.hpp>
#include <tactus/pass_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/uniform_t.hpp>
#include <tactus/visual_def_t.hpp>

#include "sync/pictures/picture_decoders.h"
#include "tests/source_dir.h"
#include "tests/visual_node/golden/colour_difference.h"
#include "tests/visual_node/golden/shipped_scene.h"
#include "visual_node/video/png.h"

using namespace tactus;
using namespace tactus::test;

namespace {

constexpr int kWidth = 160, kHeight = 120;
const std::string kFolder = source_dir() + "/tests/visual_node/golden/";

// Tolerance for other renderers: rounding to eight bits is below 0.4 of CIEDE2000, and one pixel in a hundred lies
// on an edge that falls on the other side of a sample.
constexpr double kMean = 0.4, kSeen = 0.01;
// Up to eight times half a step of eight bits, as in gl/screen_passes_test.cpp.
constexpr double kEdgesRounding = 0.02;
bool alike(const Difference& d) { return d.mean <= kMean && d.seen <= kSeen; }

struct Frame {
  std::string name, scene;
  std::function<void(scene_t&)> change;  // change of the scene as loaded from its file
  visual::Settings settings{};
  // Luminance effect of the last bit of the input of the passes: processors round it differently, and a gradient
  // amplifies it in dark areas.
  double rounding = 0;
};

int body_of(const scene_t& scene, const std::string& name) {
  for (const body_def_t& b : scene.bodies)
    if (b.name.starts_with(name)) return b.id;
  throw std::runtime_error("there is no body " + name);
}

// Close-up, so that it fills the picture.
void look_at_body(scene_t& scene, const std::string& name) {
  const Eigen::Vector3d at =
      to_eigen(scene.bodies[static_cast<std::size_t>(body_of(scene, name))].pose).translation();
  scene.camera = look_at(at + Eigen::Vector3d(-0.17, 0, 0.05), at);
  scene.camera_fov_rad = 1;
}

void pass(scene_t& scene, const std::string& shader,
          const std::vector<std::pair<std::string, float>>& uniforms = {}) {
  pass_t p{};
  p.shader = shader;
  for (const auto& [name, value] : uniforms) {
    uniform_t u{};
    u.name = name, u.count = 1, u.values[0] = value;
    p.uniforms.push_back(u);
  }
  p.uniform_count = static_cast<int>(p.uniforms.size());
  scene.passes.push_back(p);
}

std::vector<Frame> frames() {
  std::vector<Frame> all;
  for (const char* look :
       {"gouraud", "phong", "textured", "normal_mapped", "reflecting", "transparent", "stripes", "finer"})
    all.push_back({look, "looks_bench", [look](scene_t& s) { look_at_body(s, look); }});
  for (const char* shader : {"greyscale", "edges", "blur"})
    all.push_back({shader, "looks_bench", [shader](scene_t& s) {
                     look_at_body(s, "normal_mapped");
                     pass(s, shader);
                   }});
  for (Frame& f : all)
    if (f.name == "edges") f.rounding = kEdgesRounding;
  const auto as_it_is = [](scene_t&) {};
  all.push_back({"dark_room", "dark_room", as_it_is});
  all.push_back({"bump_plane", "bump_plane", as_it_is});
  Frame physics{"dark_room_physics", "dark_room", as_it_is};
  physics.settings.geometry = std::string("physics");
  all.push_back(physics);
  Frame dark{"dark_room_without_shadows", "dark_room", as_it_is};
  dark.settings.shadows = false;
  all.push_back(dark);
  for (Frame& f : all) f.settings.width = kWidth, f.settings.height = kHeight;
  return all;
}

Frame frame(const std::string& name) {
  for (const Frame& f : frames())
    if (f.name == name) return f;
  throw std::runtime_error("there is no frame " + name);
}

// change: applied to the scene in the state of the frame.
Picture draw(const Frame& frame, const std::function<void(scene_t&)>& change = {}) {
  static std::map<std::string, std::unique_ptr<ShippedScene>> scenes;
  auto& shipped = scenes[frame.scene];
  if (!shipped)
    shipped = std::make_unique<ShippedScene>(source_dir() + "/sim_node/scenes/" + frame.scene + ".sdf");
  scene_t scene = shipped->scene;
  frame.change(scene);
  if (change) change(scene);
  Picture picture = shipped->draw(scene, frame.settings);
  CHECK(shipped->warnings == std::vector<std::string>{});
  return picture;
}

std::vector<std::uint8_t> kept(const std::string& name) {
  std::ifstream file(kFolder + name + ".png", std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
  const sync::Raster raster = sync::read_raster(bytes);
  REQUIRE(raster.width == kWidth);
  REQUIRE(raster.height == kHeight);
  return raster.rgba;
}

}  // namespace

TEST_CASE("The difference of two colours matches the published examples of CIEDE2000") {
  // Sharma, Wu and Dalal (2005), eight rows of table 1.
  struct Row {
    Eigen::Vector3d one, two;
    double difference;
  };
  for (const Row& r : std::vector<Row>{{{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
                                       {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
                                       {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
                                       {{50, 0, 0}, {50, -1, 2}, 2.3669},
                                       {{50, 2.49, -0.001}, {50, -2.49, 0.0009}, 7.1792},
                                       {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
                                       {{50, 2.5, 0}, {50, 3.2592, 0.3350}, 1.0000},
                                       {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644}}) {
    CHECK(ciede2000(r.one, r.two) == Approx(r.difference).margin(1e-4));
    CHECK(ciede2000(r.two, r.one) == Approx(r.difference).margin(1e-4));
  }
}

TEST_CASE("sRGB bytes are converted to the correct lightness and colour") {
  const std::uint8_t white[]{255, 255, 255}, black[]{0, 0, 0}, red[]{255, 0, 0};
  CHECK((lab_of(white) - Eigen::Vector3d(100, 0, 0)).norm() < 0.03);
  CHECK(lab_of(black).norm() < 1e-9);
  // Lindbloom's calculator, sRGB, D65.
  CHECK((lab_of(red) - Eigen::Vector3d(53.24, 80.09, 67.20)).norm() < 0.05);
}

TEST_CASE("Shipped scenes match their stored pictures") {
  for (const Frame& f : frames()) {
    const Picture now = draw(f);
    const Difference d = difference(now.rgba, kept(f.name), f.rounding);
    if (!alike(d)) visual::write_png(f.name + ".now.png", now.rgba, kWidth, kHeight);
    INFO(f.name << ": mean difference " << d.mean << ", seen in " << 100 * d.seen
                << " % of the pixels; now: " << f.name << ".now.png");
    CHECK(alike(d));
  }
}

TEST_CASE("Every injected drawing error is detected") {
  const auto lamp_by_5_cm = [](scene_t& s) { s.lights[0].pose.position_m.y += 0.05; };
  const auto turned_over = [](scene_t& s) {
    for (look_t& l : s.looks) l.normal_map = 0;
  };
  struct Mistake {
    std::string frame, what;
    std::function<void(scene_t&)> change;
  };
  std::vector<Mistake> mistakes;
  for (const Frame& f : frames())
    if (f.name != "stripes") mistakes.push_back({f.name, "the lamp has moved by 5 cm", lamp_by_5_cm});
  mistakes.push_back({"normal_mapped", "no normal map", turned_over});
  mistakes.push_back({"textured", "no picture", [](scene_t& s) {
                        for (look_t& l : s.looks) l.colour_map = 0;
                      }});
  mistakes.push_back({"reflecting", "a tenth less is mirrored", [](scene_t& s) {
                        for (look_t& l : s.looks) l.reflectance *= 0.9f;
                      }});
  mistakes.push_back({"transparent", "a tenth more is opaque", [](scene_t& s) {
                        for (visual_def_t& v : s.visuals) v.alpha = std::min(1.0f, v.alpha * 1.1f);
                      }});
  mistakes.push_back({"stripes", "wider stripes", [](scene_t& s) {
                        for (look_t& l : s.looks)
                          for (uniform_t& u : l.uniforms) u.values[0] *= 1.1f;
                      }});
  mistakes.push_back({"phong", "a duller highlight", [](scene_t& s) {
                        for (visual_def_t& v : s.visuals) v.shininess *= 0.7f;
                      }});
  mistakes.push_back({"gouraud", "shaded by Phong", [](scene_t& s) {
                        for (look_t& l : s.looks)
                          if (l.shader == "gouraud") l.shader = "phong";
                      }});
  mistakes.push_back({"blur", "no pass", [](scene_t& s) { s.passes.clear(); }});
  for (const Mistake& m : mistakes) {
    const Frame f = frame(m.frame);
    const Difference d = difference(draw(f, m.change).rgba, kept(m.frame), f.rounding);
    INFO(m.frame << ", " << m.what << ": mean difference " << d.mean << ", seen in " << 100 * d.seen << " %");
    CHECK_FALSE(alike(d));
  }
}

TEST_CASE("The golden pictures are rewritten", "[.rewrite]") {
  for (const Frame& f : frames()) {
    const std::string file = kFolder + f.name + ".png";
    const Picture now = draw(f);
    REQUIRE(visual::write_png(file, now.rgba, kWidth, kHeight));
    std::cout << file << "\n";
  }
}
