// A shipped scene, from its file, over the bus, to a picture.
#pragma once

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <tactus/body_def_t.hpp>
#include <tactus/pose_t.hpp>
#include <tactus/scene_t.hpp>
#include <vector>

#include "lcmtypes/vectors.h"
#include "sim_node/scene/load_sdf.h"
#include "sim_node/scene/scene_assets.h"
#include "sync/assets/scene_pictures.h"
#include "sync/assets/scene_receiver.h"
#include "sync/assets/scene_sender.h"
#include "sync/bus/bus.h"
#include "visual_node/devices/display.h"
#include "visual_node/gl/renderer.h"
#include "visual_node/scene_view/meshes.h"
#include "visual_node/scene_view/scene_view.h"

namespace tactus::test {

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // sRGB, the lowest row first
};

class ShippedScene {
 public:
  explicit ShippedScene(const std::string& file)
      : bus_(sync::Identity::fresh("bench", 1), {.memory = true}),
        sender_(bus_, sim::make_assets(sim::load_sdf(file, warnings))),
        scenes_(bus_) {
    for (sync::HostTime now = sync::host_time(1'000'000'000); !scenes_.poll(now);
         now += std::chrono::milliseconds(1)) {
      sender_.poll(now);
      bus_.drain(now);
    }
    scene = *scenes_.scene();
    meshes = visual::meshes_of(scenes_);
    sync::ConfinedPictures reader;
    height_maps = visual::height_maps_of(scene, sync::pictures_of(scenes_), reader, warnings);
    look_files = visual::look_files_of(scenes_, reader, warnings);
  }

  // The scene, its lamps and looks may be changed; files that it names by hash stay. overlay: drawn over it.
  Picture draw(const scene_t& of, const visual::Settings& settings, std::vector<visual::Rect> overlay = {}) {
    static const auto display = [] {
      visual::configure_software_renderer();
      return visual::make_headless(-1);
    }();
    const visual::SceneView view(of, meshes, settings, height_maps, look_files);
    visual::Renderer renderer(view.width(), view.height(), settings.shadow_size, settings.anti_aliasing);
    renderer.load(view.geometries(), view.lighting(), view.reliefs(), view.appearance());
    for (const auto& messages : {view.warnings(), renderer.take_warnings()})
      warnings.insert(warnings.end(), messages.begin(), messages.end());
    std::vector<Eigen::Isometry3d> poses;
    for (const body_def_t& body : of.bodies) poses.push_back(to_eigen(body.pose));
    renderer.draw_scene(view.draw(poses, {}));
    visual::DrawList over;
    over.overlay = std::move(overlay);
    renderer.draw_flashes_and_overlay(over);
    renderer.wait();
    Picture picture{view.width(), view.height(), {}};
    picture.rgba.resize(static_cast<std::size_t>(4 * picture.width * picture.height));
    renderer.picture().read(picture.rgba);
    return picture;
  }

  scene_t scene;
  visual::Meshes meshes;
  visual::HeightMaps height_maps;
  visual::LookFiles look_files;
  std::vector<std::string> warnings;  // all messages so far

 private:
  sync::Bus bus_;
  sync::SceneSender sender_;
  sync::SceneReceiver scenes_;
};

// T_world_camera: level, looks along +x (SDF).
inline pose_t look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& at) {
  Eigen::Matrix3d axes;
  axes.col(0) = (at - eye).normalized();
  axes.col(1) = Eigen::Vector3d::UnitZ().cross(axes.col(0)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return to_pose(Eigen::Isometry3d(Eigen::Translation3d(eye) * Eigen::Quaterniond(axes)));
}

}  // namespace tactus::test
