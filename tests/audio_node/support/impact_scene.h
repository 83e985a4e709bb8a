// Bodies that hit each other, and the sound of their impacts.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <vector>

#include "audio_node/excitation/impact.h"
#include "audio_node/mixer/renderer.h"
#include "lcmtypes/vectors.h"

namespace tactus::audio::test {

inline material_def_t elastic_material(double E, double nu, double rho, double alpha, double beta) {
  material_def_t m{};
  m.youngs_modulus_Pa = E, m.poissons_ratio = nu, m.density_kg_m3 = rho;
  m.rayleigh_alpha_1_s = alpha, m.rayleigh_beta_s = beta, m.restitution = 0.6;
  return m;
}

inline void add_shape_body(scene_t& scene, std::int8_t kind, Eigen::Vector3d size, double mass_kg, int material_index) {
  body_def_t body{};
  body.id = scene.body_count++;
  body.tool = -1;
  body.is_static = mass_kg == 0;
  body.mass_kg = mass_kg;
  shape_def_t shape{};
  shape.body = body.id, shape.kind = kind, shape.size_m = to_vec3(size), shape.material = material_index;
  scene.bodies.push_back(body);
  scene.shapes.push_back(shape);
  scene.shape_count++;
}

// A wooden floor, a steel bar, a steel ball, a rubber ball, a steel shell.
inline scene_t impact_scene() {
  scene_t s{};
  s.materials = {elastic_material(1.1e10, .25, 750, 60, 2e-6), elastic_material(2e11, .29, 7850, 5, 3e-8),
                 elastic_material(5e6, .48, 1100, 60, 1e-4)};
  s.material_count = 3;
  add_shape_body(s, shape_def_t::BOX, {6, 6, 0.2}, 0, 0);
  add_shape_body(s, shape_def_t::BOX, {0.3, 0.03, 0.005}, 0.353, 1);
  add_shape_body(s, shape_def_t::SPHERE, {0.03, 0, 0}, 0.888, 1);
  add_shape_body(s, shape_def_t::SPHERE, {0.05, 0, 0}, 0.576, 2);
  add_shape_body(s, shape_def_t::SPHERE, {0.15, 0, 0}, 4, 1);
  s.listener.orientation.w = 1;
  return s;
}

inline contact_event_t impact_hit(int a, int b, float speed, float mass, float curvature = 30) {
  contact_event_t e{};
  e.event_id = 5, e.kind = contact_event_t::HIT, e.body_a = a, e.body_b = b, e.material_a = e.material_b = -1;
  e.approach_speed_m_s = speed, e.effective_mass_kg = mass, e.curvature_1_m = curvature;
  e.point_m.x = 1;
  return e;
}

inline Impacts impacts_of_scene(const Settings& settings = {}) {
  return Impacts(
      impact_scene(), [](std::int64_t) { return std::nullopt; }, settings, 48000, 1);
}

// Sound of one strike for a listener 1 m ahead, both channels in turn, with the whole rendering of the callback.
inline std::vector<double> rendered_strike(const Strike& strike) {
  auto queues = std::make_unique<CallbackQueues>();
  auto renderer = std::make_unique<Renderer>(*queues, RendererDef{});
  Strike at_once = strike;
  at_once.scheduled = sync::host_time(10'000'000);
  queues->strikes.push(at_once);
  std::vector<float> x(2 * 4800);
  renderer->render(x.data(), 4800, {});
  return {x.begin(), x.end()};
}
inline double largest_sample(const std::vector<double>& x) {
  double peak = 0;
  for (const double s : x) peak = std::max(peak, std::abs(s));
  return peak;
}
inline double rms_sample(const std::vector<double>& x) {
  double sum = 0;
  for (const double s : x) sum += s * s;
  return std::sqrt(sum / static_cast<double>(x.size()));
}

}  // namespace tactus::audio::test
