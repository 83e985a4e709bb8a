// The log of a run in which bodies are struck at times that a test selects, as our recorder would write it.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <tactus/asset_ref_t.hpp>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/log_info_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <vector>

#include "lcmtypes/vectors.h"
#include "sync/bus/decode.h"
#include "sync/log/log_writer.h"
#include "sync/tools/recorder/recorder_head.h"

namespace tactus::audio::test {

inline constexpr std::int64_t kLogBegins_ns = 50'000'000'000, kLogOffset_ns = 1'700'000'000'123'456'789;

// A static oak board, a steel bar and a glass ball.
inline scene_t struck_scene() {
  scene_t s{};
  const auto material = [&](const char* name, double E, double nu, double rho, double alpha, double beta) {
    material_def_t m{};
    m.name = name;
    m.youngs_modulus_Pa = E, m.poissons_ratio = nu, m.density_kg_m3 = rho;
    m.rayleigh_alpha_1_s = alpha, m.rayleigh_beta_s = beta, m.restitution = 0.5;
    s.materials.push_back(m), ++s.material_count;
  };
  material("oak", 1.1e10, .25, 750, 60, 2e-6);
  material("steel", 2e11, .29, 7850, 5, 3e-8);
  material("glass", 7e10, .22, 2500, 10, 1e-7);
  const auto add = [&](const char* name, std::int8_t kind, Eigen::Vector3d size, double mass_kg, int material) {
    body_def_t body{};
    body.name = name;
    body.id = s.body_count++;
    body.tool = -1, body.is_static = mass_kg == 0, body.mass_kg = mass_kg;
    body.pose = to_pose(Eigen::Isometry3d::Identity());
    shape_def_t shape{};
    shape.body = body.id, shape.kind = kind, shape.size_m = to_vec3(size), shape.material = material;
    shape.pose = body.pose;
    s.bodies.push_back(body), s.shapes.push_back(shape), ++s.shape_count;
  };
  add("board", shape_def_t::BOX, {0.4, 0.3, 0.02}, 0, 0);
  add("bar", shape_def_t::BOX, {0.3, 0.03, 0.005}, 0.353, 1);
  add("ball", shape_def_t::SPHERE, {0.05, 0, 0}, 0.3, 2);
  s.listener = s.camera = to_pose(Eigen::Isometry3d::Identity());
  s.step_ns = 1'000'000;
  return s;
}

class RecordedRun {
 public:
  explicit RecordedRun(std::unique_ptr<sync::LogSink> sink, const scene_t& scene = struck_scene())
      : RecordedRun(std::move(sink), {{asset_ref_t::SCENE, "scene", sync::encode(scene)}}) {}
  RecordedRun(std::unique_ptr<sync::LogSink> sink, const std::vector<sync::Asset>& assets)
      : writer_(std::move(sink)) {
    recorder_ = {"recorder", 1, 3, kRunId, kClockId};
    log_info_t info{};
    info.realtime_offset_ns = kLogOffset_ns;
    std::vector<sync::HeadAsset> head;
    for (const sync::Asset& asset : assets) {
      asset_ref_t ref{};
      ref.hash = sync::fnv1a_64(asset.bytes.data(), asset.bytes.size());
      ref.size = static_cast<std::int64_t>(asset.bytes.size());
      ref.kind = asset.kind, ref.name = asset.name;
      head.push_back({ref, &asset.bytes});
    }
    for (const sync::HeadEvent& e : sync::log_head(recorder_, info, head, sync::host_time(kLogBegins_ns)))
      write(sync::to_ns(e.time), e.channel, e.data);
  }

  // at_s: publish time since the beginning; simulated time is the same.
  void write_events(double at_s, const std::vector<contact_event_t>& events) {
    contact_events_t m{};
    stamp(m, at_s, events_seq_++);
    m.pages = 1, m.count = static_cast<std::int32_t>(events.size()), m.events = events;
    write(ns(at_s), channels::kContactEvents, sync::encode(m));
  }
  void write_contacts(double at_s, const std::vector<contact_t>& contacts) {
    contact_frame_t m{};
    stamp(m, at_s, frames_seq_++);
    m.pages = 1, m.count = static_cast<std::int32_t>(contacts.size()), m.contacts = contacts;
    write(ns(at_s), channels::kContacts, sync::encode(m));
  }
  void write_raw(double at_s, const std::string& channel, const std::vector<std::uint8_t>& bytes) {
    write(ns(at_s), channel, bytes);
  }
  void finish() { writer_.flush(); }

  static contact_event_t hit(std::int64_t id, double at_s, int a, int b, float speed_m_s = 0.5f) {
    contact_event_t e{};
    e.event_id = id, e.contact_id = id, e.kind = contact_event_t::HIT;
    e.time_ns = std::llround(at_s * 1e9);
    e.body_a = a, e.body_b = b, e.material_a = e.material_b = -1, e.tool = -1;
    e.point_m.x = 0.5f;
    e.normal.z = 1;
    e.approach_speed_m_s = speed_m_s, e.effective_mass_kg = 0.1f, e.curvature_1_m = 50;
    return e;
  }

 private:
  static constexpr std::int64_t kRunId = 7;
  static constexpr std::int32_t kClockId = 4711;

  static std::int64_t ns(double at_s) { return kLogBegins_ns + std::llround(at_s * 1e9); }
  void stamp(auto& m, double at_s, std::int64_t seq) {
    m.header = {std::llround(at_s * 1e9), ns(at_s), kClockId, kRunId, 9, 21, seq};
    m.clock = {m.header.sim_time_ns, ns(at_s), 1};
  }
  void write(std::int64_t at_ns, std::string_view channel, std::span<const std::uint8_t> data) {
    writer_.write((at_ns + kLogOffset_ns) / 1000, channel, data);
  }

  sync::LogWriter writer_;
  sync::Identity recorder_;
  std::int64_t events_seq_ = 0, frames_seq_ = 0;
};

}  // namespace tactus::audio::test
