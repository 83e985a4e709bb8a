// Cost of a frame: 20,000 triangles of rough surface under two lamps at two sizes, with and without shadows; growth with the number of
// bodies; and additional time of the loop when each frame also goes into a video. All measurements are interleaved, so that other load on
// the machine affects all of them.
//
//    bin/picture_cost triangles|bodies|video [--pictures N] [--threads N] [--json FILE] [--png FOLDER]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <tactus/body_def_t.hpp>

#include "lcmtypes/vectors.h"
#include "sync/clocks/pacing.h"
#include "sync/node/node_options.h"
#include "tests/bench/visual_node/picture_scenes.h"
#include "visual_node/devices/display.h"
#include "visual_node/gl/renderer.h"
#include "visual_node/video/png.h"
#include "visual_node/video/recording.h"

using namespace tactus;

namespace {

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

double ms_since(sync::HostTime begin) { return 1e3 * sync::to_seconds(sync::host_now() - begin); }

// A scene, ready to be drawn repeatedly.
class Scenery {
 public:
  Scenery(const bench::PictureScene& from, int width, int height, bool shadows)
      : settings_(sized(width, height, shadows)),
        view_(from.scene, from.meshes, settings_, from.height_maps),
        renderer_(view_.width(), view_.height(), settings_.shadow_size) {
    renderer_.load(view_.geometries(), view_.lighting(), view_.reliefs(), view_.appearance());
    for (const body_def_t& body : from.scene.bodies) poses_.push_back(to_eigen(body.pose));
    renderer_.warm_up(view_.draw(poses_, {}));
  }
  // From its draw list to the fence, ms.
  double draw() {
    const sync::HostTime begin = sync::host_now();
    const visual::DrawList list = view_.draw(poses_, {});
    renderer_.draw_scene(list);
    renderer_.wait();
    renderer_.draw_flashes_and_overlay(list);
    renderer_.wait();
    return ms_since(begin);
  }
  const visual::PictureTarget& picture() const { return renderer_.picture(); }
  const visual::Settings& settings() const { return settings_; }
  void save(const std::string& file) const {
    std::vector<std::uint8_t> rgba(static_cast<std::size_t>(view_.width() * view_.height() * 4));
    picture().read(rgba);
    visual::write_png(file, rgba, view_.width(), view_.height());
  }

 private:
  static visual::Settings sized(int width, int height, bool shadows) {
    visual::Settings s;
    s.width = width, s.height = height, s.shadows = shadows;
    return s;
  }
  visual::Settings settings_;
  visual::SceneView view_;
  visual::Renderer renderer_;
  std::vector<Eigen::Isometry3d> poses_;
};

struct Row {
  std::string name;
  std::unique_ptr<Scenery> scenery;
  std::vector<double> ms;
};

struct Options {
  int pictures = 120;
  std::string table, json, png;
  int threads = 0;
};

void draw_in_turns(std::vector<Row>& rows, const Options& options) {
  for (int i = 0; i < options.pictures; ++i)
    for (Row& row : rows) row.ms.push_back(row.scenery->draw());
  if (!options.png.empty())
    for (Row& row : rows) row.scenery->save(options.png + "/" + row.name + ".png");
}

nlohmann::json table(const std::vector<Row>& rows) {
  nlohmann::json all;
  std::printf("| | p50 ms | p95 ms | pictures/s at p50 |\n|---|---|---|---|\n");
  for (const Row& row : rows) {
    const double p50 = quantile(row.ms, 0.5), p95 = quantile(row.ms, 0.95);
    std::printf("| %s | %.1f | %.1f | %.0f |\n", row.name.c_str(), p50, p95, 1000 / p50);
    all[row.name] = {{"p50_ms", p50}, {"p95_ms", p95}, {"pictures", row.ms.size()}};
  }
  std::printf("\n");
  return all;
}

nlohmann::json triangles(const Options& options) {
  const bench::PictureScene scene = bench::rough_balls();
  std::printf("%d triangles, all rough, a spot light and a point light\n\n", scene.triangles);
  std::vector<Row> rows;
  for (const auto& [width, height] : {std::pair{960, 540}, {1280, 720}})
    for (const bool shadows : {false, true})
      rows.push_back({std::to_string(width) + "x" + std::to_string(height) + (shadows ? " with shadows" : ""),
                      std::make_unique<Scenery>(scene, width, height, shadows),
                      {}});
  draw_in_turns(rows, options);
  return table(rows);
}

nlohmann::json bodies(const Options& options) {
  std::printf("bodies: boxes and balls side by side, 640x480, no shadows\n\n");
  std::vector<Row> rows;
  for (const int count : {10, 100, 1000, 3000})
    rows.push_back({std::to_string(count) + " bodies",
                    std::make_unique<Scenery>(bench::many_bodies(count), 640, 480, false),
                    {}});
  draw_in_turns(rows, options);
  nlohmann::json all = table(rows);
  // Linear growth: the cost per body between 100 and 1,000 equals that between 1,000 and 3,000.
  const auto p50 = [&](std::size_t row) { return quantile(rows[row].ms, 0.5); };
  const double first_us = 1e3 * (p50(2) - p50(1)) / 900, second_us = 1e3 * (p50(3) - p50(2)) / 2000;
  std::printf("a body adds %.2f us from 100 to 1,000 and %.2f us from 1,000 to 3,000\n\n", first_us, second_us);
  all["us_a_body"] = {{"100_to_1000", first_us}, {"1000_to_3000", second_us}};
  return all;
}

// As in the node: a frame each 1/60 s, which the writer's thread encodes on the other core.
nlohmann::json video(const Options& options) {
  std::printf("640x480 at 60 Hz: time of the loop per picture, without and with video output\n\n");
  Scenery scenery(bench::rough_balls(), 640, 480, false);
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("picture_cost." + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::vector<double> alone, with_video, handing_over;
  {
    visual::RecordingOptions keep;
    keep.folder = folder.string();
    visual::Recording recording(keep);
    recording.begin(640, 480, scenery.settings());
    std::int64_t tick = 0;
    const auto read = [&](std::span<std::uint8_t> rgba) { scenery.picture().read(rgba); };
    sync::Loop loop(scenery.settings().rate_Hz);
    // Rounds of half a second, the first of each after a pause in which the encoder catches up.
    for (int turn = 0; turn < std::max(2, options.pictures / 15); ++turn) {
      const bool on = turn % 2 == 1;
      for (int i = 0; i < 30; ++i) {
        const sync::HostTime begin = loop.wait();
        scenery.draw();
        const double drawn_ms = ms_since(begin);
        if (on) recording.add(tick++, begin, read);
        const double busy_ms = ms_since(begin);
        if (i < 5) continue;  // still affected by the previous round
        (on ? with_video : alone).push_back(busy_ms);
        if (on) handing_over.push_back(busy_ms - drawn_ms);
      }
    }
    if (const std::string note = recording.status_text(); !note.empty()) std::printf("%s\n", note.c_str());
  }
  std::filesystem::remove_all(folder);
  const double a = quantile(alone, 0.5), w = quantile(with_video, 0.5), h = quantile(handing_over, 0.5);
  std::printf(
      "| alone p50 ms | with video p50 ms | share of the hand-over | increase |\n|---|---|---|---|\n| %.2f | %.2f "
      "| "
      "%.2f | %.1f %% |\n\n",
      a, w, h, 100 * (w / a - 1));
  return {{"alone_p50_ms", a}, {"with_video_p50_ms", w}, {"handing_over_p50_ms", h}, {"more", w / a - 1}};
}

}  // namespace

int main(int argc, char** argv) try {
  Options options;
  tactus::sync::Arguments app("Cost of a picture: triangles, bodies, video.");
  app.add_option("--pictures", options.pictures, "of each row")
      .range(1, 100000)
      .show_default();
  app.add_option("TABLE", options.table, "what to measure")
      .required()
      .one_of({"triangles", "bodies", "video"});
  app.add_option("--threads", options.threads,
                 "threads of a software renderer; 0: 2, or 1 with a video, as in visual_node")
      .range(0, 64)
      .show_default();
  app.add_option("--json", options.json, "file for the figures");
  app.add_option("--png", options.png, "folder for a picture of each row").existing_folder();
  tactus::sync::parse_or_exit(app, "picture_cost", argc, argv);
  if (options.threads == 0) options.threads = options.table == "video" ? 1 : 2;
  setenv("LP_NUM_THREADS", std::to_string(options.threads).c_str(), 1);
  visual::configure_software_renderer();
  const auto display = visual::make_headless(-1);
  std::printf("%s, drawn by %d threads if it is a software renderer\n\n", display->description().c_str(),
              options.threads);
  nlohmann::json all{{"renderer", display->description()}, {"threads", options.threads}};
  for (const auto& [name, measure] : {std::pair{"triangles", &triangles}, {"bodies", &bodies}, {"video", &video}})
    if (options.table == name) all[name] = measure(options);
  if (!options.json.empty() && !(std::ofstream(options.json) << all.dump(1) << "\n"))
    throw std::runtime_error("cannot write " + options.json);
  return 0;
} catch (const std::exception& e) {
  std::cerr << "picture_cost: " << e.what() << "\n";
  return 1;
}
