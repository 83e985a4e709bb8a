// Draws a scene on the walls of a room, unfolded around the front, and prints how well they meet: mean difference of the pixels on both
// sides of an edge, compared with neighbours within a wall.
//
//    bin/draw_walls OUT.png [SCENE.sdf] [--room ROOM] [--edge PIXELS] [--at X Y Z] [--set name=value]...
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <tactus/body_def_t.hpp>
#include <tactus/scene_t.hpp>

#include "lcmtypes/vectors.h"
#include "sim_node/scene/load_sdf.h"
#include "sim_node/scene/scene_assets.h"
#include "sync/assets/scene_sender.h"
#include "sync/bus/bus.h"
#include "sync/node/node_options.h"
#include "sync/text/settings.h"
#include "visual_node/devices/display.h"
#include "visual_node/gl/renderer.h"
#include "visual_node/scene_view/meshes.h"
#include "visual_node/video/png.h"

using namespace tactus;

namespace {

using Pixels = std::vector<std::uint8_t>;

// Position of a wall in the picture, in walls from the lower left.
struct Place {
  std::string wall;
  int column, row;
};
const std::vector<Place> kUnfolded{{"left", 0, 1}, {"front", 1, 1}, {"right", 2, 1}, {"back", 3, 1}, {"floor", 1, 0}, {"ceiling", 1, 2}};

struct Sheet {
  int edge, columns, rows;
  Pixels rgba = Pixels(static_cast<std::size_t>(edge * columns * edge * rows) * 4);

  const std::uint8_t* at(int x, int y) const { return &rgba[static_cast<std::size_t>((y * edge * columns + x) * 4)]; }
  double difference(int x, int y, int other_x, int other_y) const {
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += std::abs(at(x, y)[c] - at(other_x, other_y)[c]);
    return sum / 3;
  }
  // Mean difference of the pixels on both sides of the line below or to the left of `column, row`.
  double across(int column, int row, bool upright) const {
    double sum = 0;
    for (int i = 0; i < edge; ++i)
      sum += upright ? difference(column * edge - 1, row * edge + i, column * edge, row * edge + i)
                     : difference(column * edge + i, row * edge - 1, column * edge + i, row * edge);
    return sum / edge;
  }
  // The same, for all lines within that wall.
  double within(int column, int row, bool upright) const {
    double sum = 0;
    for (int n = 1; n < edge; ++n)
      for (int i = 0; i < edge; ++i)
        sum += upright ? difference(column * edge + n - 1, row * edge + i, column * edge + n, row * edge + i)
                       : difference(column * edge + i, row * edge + n - 1, column * edge + i, row * edge + n);
    return sum / (edge * (edge - 1));
  }
};

}  // namespace

int main(int argc, char** argv) try {
  std::string scene_file = TACTUS_SOURCE_DIR "/sim_node/scenes/dark_room.sdf", out, room = "cave4", json;
  int edge = 400;
  std::vector<std::string> set;
  std::vector<double> at;
  tactus::sync::Arguments app("Draws the pictures of all walls of a room, unfolded.");
  app.add_option("OUT", out, "PNG file").required();
  app.add_option("SCENE", scene_file, "SDF file").existing_file();
  app.add_option("--room", room, "cave4 or cave6").one_of({"cave4", "cave6"}).show_default();
  app.add_option("--edge", edge, "of each wall, pixels; a multiple of 4").range(320, 2048).show_default();
  app.add_option("--at", at, "where the person's eye is, m; not given: where the scene's camera is").expected(3);
  app.add_option("--set", set, "a setting of visual_node, name=value");
  app.add_option("--json", json, "also writes the figures to this file");
  tactus::sync::parse_or_exit(app, "draw_walls", argc, argv);
  edge = edge / 4 * 4;

  std::vector<std::string> said;
  sync::Bus bus(sync::Identity::fresh("bench", 1), {.memory = true});
  sync::SceneSender sender(bus, sim::make_assets(sim::load_sdf(scene_file, said)));
  sync::SceneReceiver scenes(bus);
  for (sync::HostTime now = sync::host_time(1'000'000'000); !scenes.poll(now); now += std::chrono::milliseconds(1)) {
    sender.poll(now);
    bus.drain(now);
  }
  scene_t scene = *scenes.scene();
  if (!at.empty()) scene.camera.position_m = to_vec3({at[0], at[1], at[2]});
  visual::configure_software_renderer();
  const auto display = visual::make_headless(-1);
  std::vector<Eigen::Isometry3d> poses;
  for (const body_def_t& body : scene.bodies) poses.push_back(to_eigen(body.pose));

  Sheet sheet{edge, room == "cave4" ? 3 : 4, room == "cave4" ? 2 : 3};
  std::vector<Place> drawn;
  sync::ConfinedPictures reader;
  for (const Place& place : kUnfolded) {
    if (place.column >= sheet.columns || place.row >= sheet.rows) continue;
    visual::Settings settings;
    set.insert(set.end(), {"room=" + room, "wall=" + place.wall, "width=" + std::to_string(edge), "height=" + std::to_string(edge)});
    for (const std::string& wrong : sync::apply_settings(settings, visual::setting_fields(), "visual_node", scene.settings, set))
      throw std::runtime_error(wrong);
    const visual::SceneView view(scene, visual::meshes_of(scenes), settings,
                                 visual::height_maps_of(*scenes.scene(), sync::pictures_of(scenes), reader, said),
                                 visual::look_files_of(scenes, reader, said));
    if (!view.lens().warning().empty()) throw std::runtime_error(view.lens().warning());
    visual::Renderer renderer(edge, edge, settings.shadow_size);
    renderer.load(view.geometries(), view.lighting(), view.reliefs(), view.appearance());
    renderer.draw_scene(view.draw(poses, {}));
    renderer.draw_flashes_and_overlay({});
    renderer.wait();
    Pixels wall(static_cast<std::size_t>(edge * edge) * 4);
    renderer.picture().read(wall);
    for (int y = 0; y < edge; ++y)
      std::copy_n(&wall[static_cast<std::size_t>(y * edge) * 4], static_cast<std::size_t>(edge) * 4,
                  &sheet.rgba[static_cast<std::size_t>(((place.row * edge + y) * sheet.columns + place.column) * edge) * 4]);
    drawn.push_back(place);
  }
  if (!visual::write_png(out, sheet.rgba, edge * sheet.columns, edge * sheet.rows)) throw std::runtime_error("cannot write " + out);

  nlohmann::json rows = nlohmann::json::array();
  std::printf("%s, walls of %d x %d pixels\n| edge | mean difference across it, of 255 | within both walls |\n|---|---|---|\n", display->description().c_str(), edge, edge);
  for (const Place& a : drawn)
    for (const Place& b : drawn) {
      const bool upright = b.column == a.column + 1 && b.row == a.row;
      if (!upright && !(b.row == a.row + 1 && b.column == a.column)) continue;
      const double across = sheet.across(b.column, b.row, upright);
      const double within = 0.5 * (sheet.within(a.column, a.row, upright) + sheet.within(b.column, b.row, upright));
      std::printf("| %s, %s | %.2f | %.2f |\n", a.wall.c_str(), b.wall.c_str(), across, within);
      rows.push_back({{"a", a.wall}, {"b", b.wall}, {"across", across}, {"within", within}});
    }
  if (!json.empty()) std::ofstream(json) << rows.dump(2) << "\n";
  return 0;
} catch (const std::exception& e) {
  std::cerr << "draw_walls: " << e.what() << "\n";
  return 1;
}
