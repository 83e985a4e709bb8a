// Cost of a frame in each step of the quality ladder of vision, and at a coarse resolution: time from its beginning to the fence after the
// surfaces and to the fence after the flashes. The steps are interleaved, so that other load on the machine affects all of them.
//
//    bin/picture_quality [SCENE.sdf] [--pictures N] [--png FOLDER]
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_event_t.hpp>

#include "lcmtypes/vectors.h"
#include "sim_node/scene/load_sdf.h"
#include "sim_node/scene/scene_assets.h"
#include "sync/assets/scene_sender.h"
#include "sync/bus/bus.h"
#include "sync/clocks/pacing.h"
#include "sync/node/node_options.h"
#include "visual_node/devices/display.h"
#include "visual_node/frame/marker.h"
#include "visual_node/gl/renderer.h"
#include "visual_node/scene_view/flashes.h"
#include "visual_node/scene_view/meshes.h"
#include "visual_node/video/png.h"

using namespace tactus;

namespace {

struct Row {
  std::string name;
  visual::Quality quality;
  std::vector<double> surfaces_ms, picture_ms;
};

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

double ms_since(sync::HostTime begin) { return 1e3 * sync::to_seconds(sync::host_now() - begin); }

}  // namespace

int main(int argc, char** argv) try {
  std::string scene_file = TACTUS_SOURCE_DIR "/sim_node/scenes/dark_room.sdf", png;
  int pictures = 200;
  tactus::sync::Arguments app("Cost of a picture at each quality step of visual_node.");
  app.add_option("SCENE", scene_file, "SDF file").existing_file();
  app.add_option("--pictures", pictures, "of each step").range(1, 100000).show_default();
  app.add_option("--png", png, "folder to write the last picture of each step to").existing_folder();
  tactus::sync::parse_or_exit(app, "picture_quality", argc, argv);

  std::vector<std::string> said;
  sync::Bus bus(sync::Identity::fresh("bench", 1), {.memory = true});
  sync::SceneSender sender(bus, sim::make_assets(sim::load_sdf(scene_file, said)));
  sync::SceneReceiver scenes(bus);
  for (sync::HostTime now = sync::host_time(1'000'000'000); !scenes.poll(now);
       now += std::chrono::milliseconds(1)) {
    sender.poll(now);
    bus.drain(now);
  }
  visual::configure_software_renderer();
  const auto display = visual::make_headless(-1);
  const visual::Settings settings;
  sync::ConfinedPictures reader;
  const visual::SceneView view(*scenes.scene(), visual::meshes_of(scenes), settings,
                               visual::height_maps_of(*scenes.scene(), sync::pictures_of(scenes), reader, said));
  visual::Renderer renderer(view.width(), view.height(), settings.shadow_size);
  renderer.load(view.geometries(), view.lighting(), view.reliefs(), view.appearance());
  std::vector<Eigen::Isometry3d> poses;
  for (const body_def_t& body : scenes.scene()->bodies) poses.push_back(to_eigen(body.pose));
  visual::DrawList list = view.draw(poses, {});
  visual::Flashes flashes(settings);
  contact_event_t event{};
  event.event_id = 42;
  event.kind = contact_event_t::HIT;
  event.normal.z = 1;
  event.approach_speed_m_s = 1;
  flashes.add(event, sync::host_time(0));
  list.glows = flashes.frame(sync::host_time(20'000'000), list.camera);
  visual::append_marker(list.overlay, 7, flashes.shown(), view.height());

  renderer.warm_up(view.draw(poses, {}));

  std::vector<Row> rows;
  for (std::size_t i = 0; i < visual::kQualities.size(); ++i)
    rows.push_back({"step " + std::to_string(i), visual::kQualities[i], {}, {}});
  rows.push_back({"resolution 0.25", visual::degraded(visual::kQualities[0], 0.25), {}, {}});
  std::vector<std::uint8_t> rgba(static_cast<std::size_t>(view.width() * view.height() * 4));
  for (int i = 0; i < pictures; ++i)
    for (Row& row : rows) {
      renderer.set_quality(row.quality);
      const sync::HostTime begin = sync::host_now();
      renderer.draw_scene(list);
      renderer.wait();
      row.surfaces_ms.push_back(ms_since(begin));
      renderer.draw_flashes_and_overlay(list);
      renderer.wait();
      row.picture_ms.push_back(ms_since(begin));
      renderer.picture().read(rgba);
      if (!png.empty() && i + 1 == pictures)
        visual::write_png(png + "/" + row.name + ".png", rgba, view.width(), view.height());
    }
  std::printf("%s, %d x %d pixels, %d pictures each\n", display->description().c_str(), view.width(),
              view.height(), pictures);
  std::printf("| ms | surfaces p50 | picture p50 | p95 | first |\n|---|---|---|---|---|\n");
  for (const Row& row : rows)
    std::printf("| %s | %.1f | %.1f | %.1f | %.1f |\n", row.name.c_str(), quantile(row.surfaces_ms, 0.5),
                quantile(row.picture_ms, 0.5), quantile(row.picture_ms, 0.95), row.picture_ms.front());
  return 0;
} catch (const std::exception& e) {
  std::cerr << "picture_quality: " << e.what() << "\n";
  return 1;
}
