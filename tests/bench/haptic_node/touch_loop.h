// A hand and a world without a bus or a clock: the simulation at 1 kHz and touch at any rate. Messages of each reach the other with its
// next step.
#pragma once

#include <cmath>
#include <optional>
#include <tactus/scene_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <utility>
#include <vector>

#include "haptic_node/rendering/renderer.h"
#include "haptic_node/contact/rotation_math.h"
#include "sim_node/world/simulation.h"

namespace tactus::test {

inline scene_t scene_of(const sim::WorldDef& world) {
  scene_t s{};
  s.step_ns = 1'000'000;
  s.bodies.resize(world.bodies.size());
  s.body_count = static_cast<std::int32_t>(s.bodies.size());
  s.tools = world.tools;
  s.tool_count = static_cast<std::int32_t>(s.tools.size());
  s.materials = world.materials;
  s.material_count = static_cast<std::int32_t>(s.materials.size());
  return s;
}

class TouchLoop {
 public:
  TouchLoop(const sim::WorldDef& world, const haptic::Settings& settings, const sim::Settings& of_sim = {})
      : settings_(settings),
        simulation_(world, of_sim),
        safety_(haptic::safety_limits(settings)),
        renderer_(scene_of(world), 0, settings, safety_),
        per_step_(std::max<std::int64_t>(1, std::llround(settings.rate_Hz / 1000))) {
    simulation_.start(1);
  }

  // One tick of touch with the device at this pose; its velocities follow from the previous pose.
  const haptic::TickOutput& tick(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation) {
    haptic::DeviceState device;
    device.position = position;
    device.orientation = orientation;
    if (last_) {
      device.velocity = (position - last_->first) * settings_.rate_Hz;
      device.spin = haptic::rotation_between(last_->second, orientation) * settings_.rate_Hz;
    }
    last_.emplace(position, orientation);
    return tick(device);
  }
  const haptic::TickOutput& tick(const haptic::DeviceState& device) {
    const std::int64_t ns = std::llround(1e9 * static_cast<double>(ticks_) / settings_.rate_Hz);
    haptic::TickInput in;
    in.now = sync::host_time(kBegins_ns + ns);
    in.device = device;
    in.map = sync::TimeMap{sync::sim_time(0), sync::host_time(kBegins_ns), 1};
    if (std::exchange(sent_, false)) in.fresh = &on_the_way_, arrival_ = in.now;
    in.touch_arrival = arrival_;
    const haptic::TickOutput& out = renderer_.step(in);
    news_.push_back(out.state);
    news_.back().header.incarnation = 7;
    news_.back().header.seq = ticks_;
    news_.back().header.publish_time_ns = kBegins_ns + ns;
    if (ticks_ % per_step_ == 0) {
      simulation_.step(news_);
      news_.clear();
      on_the_way_ = simulation_.touch_models()[0];
      on_the_way_.header.sim_time_ns = sync::to_ns(simulation_.now());
      sent_ = true;
    }
    ++ticks_;
    return out;
  }

  double time_s() const { return static_cast<double>(ticks_) / settings_.rate_Hz; }
  sim::Simulation& world() { return simulation_; }
  const touch_model_t& model() const { return on_the_way_; }
  haptic::Renderer& renderer() { return renderer_; }

 private:
  static constexpr std::int64_t kBegins_ns = 5'000'000'000;  // host time of simulated time zero

  haptic::Settings settings_;
  sim::Simulation simulation_;
  haptic::Safety safety_;
  haptic::Renderer renderer_;
  std::int64_t per_step_, ticks_ = 0;
  std::vector<tool_state_t> news_;
  touch_model_t on_the_way_{};
  bool sent_ = false;
  std::optional<sync::HostTime> arrival_;
  std::optional<std::pair<Eigen::Vector3d, Eigen::Quaterniond>> last_;
};

}  // namespace tactus::test
