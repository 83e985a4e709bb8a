// A hand that strokes static surfaces, without a bus or a clock: the touch model of the simulation (ToolTouch, at 1 kHz) and its rendering
// (haptic::Renderer, at any rate).
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <tactus/contact_event_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <utility>
#include <vector>

#include "haptic_node/rendering/renderer.h"
#include "sim_node/touch/tool_touch.h"
#include "tests/bench/haptic_node/touch_loop.h"

namespace tactus::bench {

inline constexpr double kStiffness_N_m = 1000;  // stiffness of every stroked surface

class StrokeLoop {
 public:
  // Uses the first tool of that world. world, trees: outlive this.
  StrokeLoop(const sim::WorldDef& world, sim::MeshTrees& trees, const haptic::Settings& settings)
      : rate_Hz_(settings.rate_Hz),
        per_step_(static_cast<std::int64_t>(settings.rate_Hz / 1000)),
        touch_(world, 0, stiff(), ids_, trees),
        safety_(haptic::safety_limits(settings)),
        renderer_(test::scene_of(world), 0, settings, safety_) {
    for (const sim::BodyDef& b : world.bodies) {
      sim::BodyMotion m;
      m.position_m = m.centre_m = b.pose.translation();
      bodies_.push_back(m);
    }
  }

  // One tick with the device at this position, at time_s(); its velocity follows from the previous position.
  const haptic::TickOutput& tick(const Eigen::Vector3d& device) {
    const std::int64_t ns = time_ns();
    haptic::TickInput in;
    in.now = sync::host_time(kBegins_ns + ns);
    in.device.position = device;
    in.device.velocity = (device - last_device_.value_or(device)) * rate_Hz_;
    last_device_ = device;
    in.map = sync::TimeMap{sync::sim_time(0), sync::host_time(kBegins_ns), 1};
    // The touch model of the last step arrives with the next tick.
    if (std::exchange(sent_, false)) in.fresh = &on_the_way_, arrival_ = in.now;
    in.touch_arrival = arrival_;
    const haptic::TickOutput& out = renderer_.step(in);
    news_.push_back(out.state);
    if (ticks_ % per_step_ == 0) {
      events_.clear();
      touch_.update(sync::sim_time(ns), bodies_, news_, events_);
      news_.clear();
      on_the_way_ = touch_.model();
      on_the_way_.header.sim_time_ns = ns;
      sent_ = true;
    }
    change_N_ = (out.force_N - last_force_N_).norm();
    last_force_N_ = out.force_N;
    ++ticks_;
    return out;
  }

  double time_s() const { return 1e-9 * static_cast<double>(time_ns()); }  // of the next tick
  double change_N() const { return change_N_; }                            // change of the force in the last tick
  const touch_model_t& model() const { return on_the_way_; }
  haptic::Renderer& renderer() { return renderer_; }

 private:
  static constexpr std::int64_t kBegins_ns = 5'000'000'000;  // host time of simulated time zero

  static sim::Settings stiff() {
    sim::Settings s;
    s.touch_stiffness_N_m = kStiffness_N_m;
    return s;
  }
  std::int64_t time_ns() const { return std::llround(1e9 * static_cast<double>(ticks_) / rate_Hz_); }

  double rate_Hz_;
  std::int64_t per_step_, ticks_ = 0;
  sim::Ids ids_{1};
  sim::ToolTouch touch_;
  haptic::Safety safety_;
  haptic::Renderer renderer_;
  std::vector<sim::BodyMotion> bodies_;
  std::vector<tool_state_t> news_;
  std::vector<contact_event_t> events_;
  touch_model_t on_the_way_{};
  bool sent_ = false;
  std::optional<sync::HostTime> arrival_;
  std::optional<Eigen::Vector3d> last_device_;
  Eigen::Vector3d last_force_N_ = Eigen::Vector3d::Zero();
  double change_N_ = 0;
};

}  // namespace tactus::bench
