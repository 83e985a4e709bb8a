// Replaces sim_node in measurements of sound timing: a dull board around the listener and a ball that strikes it at random times and
// places, on every side, one hit at a time, without end. Each hit is published as the simulation does, in the step of its time and for 50
// ms after.
//
//    in   ASSET_REQUEST
//    out  SCENE_MANIFEST, ASSET_CHUNK, CONTACT_EVENTS, CONTACTS
#include <cmath>
#include <iostream>
#include <random>
#include <tactus/asset_ref_t.hpp>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/sim_clock_t.hpp>

#include "lcmtypes/vectors.h"
#include "sync/node/node.h"
#include "sync/assets/scene_sender.h"

using namespace tactus;

namespace {

constexpr double kLeastGap_s = 0.07, kMaxGap_s = 0.13;  // 10 per second; the board is silent again by then
constexpr double kAround_m = 0.08;                       // distance from the listener, who is in the middle of the board
constexpr sync::Nanoseconds kRepeat{50'000'000};         // as sim_node/publish repeats its events
constexpr sync::Nanoseconds kGrace{3'000'000'000};       // time to load the scene, as sim_node's scene_grace
constexpr int kSnapshotEvery = 17;                       // ticks: 60 Hz

// Stiff, so that the impact is short, and damped so that each sound ends before the next: by 1/e in 3 ms.
scene_t dull_board() {
  scene_t s{};
  material_def_t dull{};
  dull.name = "dull", dull.youngs_modulus_Pa = 7e10, dull.poissons_ratio = .25, dull.density_kg_m3 = 2500;
  dull.rayleigh_alpha_1_s = 600, dull.rayleigh_beta_s = 1e-7, dull.restitution = 0.3;
  s.materials.push_back(dull), s.material_count = 1;
  const auto add = [&](const char* name, std::int8_t kind, const Eigen::Vector3d& size_m, double mass_kg) {
    body_def_t body{};
    body.name = name, body.id = s.body_count++, body.tool = -1;
    body.is_static = mass_kg == 0, body.mass_kg = mass_kg;
    body.pose = to_pose(Eigen::Isometry3d::Identity());
    shape_def_t shape{};
    shape.body = body.id, shape.kind = kind, shape.size_m = to_vec3(size_m), shape.pose = body.pose;
    s.bodies.push_back(body), s.shapes.push_back(shape), ++s.shape_count;
  };
  add("board", shape_def_t::BOX, {0.3, 0.2, 0.02}, 0);
  add("ball", shape_def_t::SPHERE, {0.01, 0, 0}, 0.01);
  s.listener = s.camera = to_pose(Eigen::Isometry3d::Identity());
  s.camera_fov_rad = 1, s.step_ns = 1'000'000;
  return s;
}

contact_event_t hit(std::int64_t id, std::int64_t time_ns, double azimuth_rad) {
  contact_event_t e{};
  e.event_id = e.contact_id = id, e.kind = contact_event_t::HIT, e.time_ns = time_ns;
  e.body_b = 1, e.tool = -1;
  e.point_m.x = static_cast<float>(kAround_m * std::cos(azimuth_rad));
  e.point_m.y = static_cast<float>(kAround_m * std::sin(azimuth_rad));
  e.normal.z = 1;
  e.approach_speed_m_s = 1, e.effective_mass_kg = 0.01f, e.curvature_1_m = 100;
  return e;
}

}  // namespace

int main(int argc, char** argv) try {
  const sync::NodeDescriptor descriptor{.name = "sim_node",
                                        .modality = "",
                                        .rate_Hz = 1000,
                                        .fifo_priority = 50,
                                        .about = "Replaces sim_node: strikes a board at random times."};
  sync::Arguments app;
  sync::NodeOptions options;
  std::string scene_file;
  options.add_to(app, descriptor);
  app.add_option("SCENE", scene_file, "ignored: the board is always the same");
  sync::parse_or_exit(app, descriptor.name, argc, argv);

  sync::Node node(descriptor, options);
  sync::SceneSender scene_sender(node.bus(), {{asset_ref_t::SCENE, "scene", sync::encode(dull_board())}});
  node.set_state(node_health_t::WAITING, "offers the scene; its time has not begun");
  const sync::HostTime grace_ends = sync::host_now() + kGrace;
  while (node.running() && node.wait() < grace_ends) scene_sender.poll(sync::host_now());
  node.set_state(node_health_t::RUNNING);
  std::cerr << "sim_node: the world begins" << std::endl;

  std::mt19937_64 random(options.seed);
  std::uniform_real_distribution<double> gap_s(kLeastGap_s, kMaxGap_s), azimuth_rad(-M_PI, M_PI);
  const sync::HostTime begin = sync::host_now();
  sync::Nanoseconds next = sync::from_seconds(1);
  std::int64_t hits = 0, ticks = 0;
  std::vector<contact_event_t> repeated;
  while (node.running()) {
    const sync::HostTime now = node.wait();
    scene_sender.poll(now);
    const sync::Nanoseconds time = now - begin;
    for (; next <= time; next += sync::from_seconds(gap_s(random)))
      repeated.push_back(hit(sync::prefixed_id(node.bus().identity().incarnation, hits++), next.count(), azimuth_rad(random)));
    std::erase_if(repeated, [&](const contact_event_t& e) { return time.count() - e.time_ns > kRepeat.count(); });
    const sim_clock_t clock{time.count(), sync::to_ns(now), 1};
    if (!repeated.empty()) {
      contact_events_t m{};
      m.header.sim_time_ns = time.count(), m.clock = clock, m.pages = 1;
      m.events = repeated, m.count = static_cast<std::int32_t>(repeated.size());
      node.bus().publish(channels::kContactEvents, m);
    }
    if (ticks++ % kSnapshotEvery == 0) {
      contact_frame_t m{};
      m.header.sim_time_ns = time.count(), m.clock = clock, m.pages = 1;
      node.bus().publish(channels::kContacts, m);
    }
  }
  return 0;
} catch (const std::exception& e) {
  return sync::fail("sim_node", e);
}
