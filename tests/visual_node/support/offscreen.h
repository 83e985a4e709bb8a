// Offscreen pictures for the tests of this folder.
#pragma once

#include <algorithm>
#include <cmath>
#include <tactus/body_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <vector>

#include "tests/visual_node/support/test_scene.h"
#include "visual_node/devices/display.h"
#include "visual_node/gl/renderer.h"
#include "visual_node/scene_view/scene_view.h"

namespace tactus::test {

inline constexpr int kWidth = 640, kHeight = 480;

// IEC 61966-2-1.
inline double srgb(double linear) {
  linear = std::clamp(linear, 0.0, 1.0);
  return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

inline visual::Display& display() {
  static const auto context = [] {
    visual::configure_software_renderer();
    return visual::make_headless(-1);
  }();
  return *context;
}

struct Image {
  std::vector<std::uint8_t> rgba = std::vector<std::uint8_t>(kWidth * kHeight * 4);
  // x from the left, y from the top.
  Eigen::Vector3d at(int x, int y) const {
    const auto i = static_cast<std::size_t>(((kHeight - 1 - y) * kWidth + x) * 4);
    return {static_cast<double>(rgba[i]), static_cast<double>(rgba[i + 1]), static_cast<double>(rgba[i + 2])};
  }
};

// Draws with a renderer that may have drawn before.
inline Image draw(visual::Renderer& renderer, const visual::DrawList& list, const visual::Quality& quality = {}) {
  renderer.set_quality(quality);
  renderer.draw_scene(list);
  renderer.wait();
  renderer.draw_flashes_and_overlay(list);
  renderer.wait();
  Image image;
  renderer.picture().read(image.rgba);
  return image;
}

inline Image render(const scene_t& scene, const visual::Settings& settings = {},
                    std::vector<visual::Rect> overlay = {}, const visual::HeightMaps& height_maps = {},
                    const visual::Quality& quality = {}) {
  display();
  const visual::SceneView view(scene, {}, settings, height_maps);
  visual::Renderer renderer(kWidth, kHeight, settings.shadow_size);
  renderer.load(view.geometries(), view.lighting(), view.reliefs(), view.appearance());
  std::vector<Eigen::Isometry3d> poses;
  for (const body_def_t& b : scene.bodies) poses.push_back(to_eigen(b.pose));
  visual::DrawList list = view.draw(poses, {});
  list.overlay = std::move(overlay);
  return draw(renderer, list, quality);
}

// A floor of 10 m at z = 0 seen straight from above, the middle of the picture at the origin; picture up is +x.
inline scene_t floor_from_above(double height_m) {
  scene_t scene = empty_scene();
  add_visual(scene, add_body(scene, {0, 0, 0}), shape_def_t::PLANE, {10, 10, 0});
  scene.camera = to_pose(Eigen::Isometry3d(Eigen::Translation3d(0, 0, height_m) *
                                           Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitY())));
  return scene;
}

// Pixels per metre on that floor.
inline double scale_px(double height_m) { return kWidth / 2 / std::tan(0.5) / height_m; }

// Tolerance: 8 bits, and the error of the device's own sRGB encoding.
inline constexpr double kTolerance = 2;

}  // namespace tactus::test
