// The reports of a renderer: the state of a tick, and the limits of its device.
#include <algorithm>

#include "haptic_node/rendering/renderer.h"
#include "lcmtypes/vectors.h"

namespace tactus::haptic {
namespace {

constexpr double kMaxReported_J = 1e6;  // the range of the message
// Touch that is softer than this share of that of an immediate device is reported. Design: 0.7, as for the largest
// difference of stiffness that passes unnoticed in a comparison (unverified).
constexpr double kSoftened = 0.7;

}  // namespace

sync::Nanoseconds Renderer::uncertainty() const {
  return sync::from_seconds(period_s_ / 2 + settings_.device_uncertainty_s);
}

Renderer::DeviceLimit Renderer::device_limit() const {
  constexpr double kRigid_N_m = 1e12, kFixed_kg = 1e10;
  const auto wall = [&](double hold, double delay) {
    return coupling_gains(kRigid_N_m, 0, kFixed_kg, period_s_, hold, coupling_, delay).stiffness_N_m;
  };
  const double limit = wall(hold_s(), device_.loop.delay_s);
  return {device_.loop, limit, limit < kSoftened * wall(period_s_, 0)};
}

sync::SampleStatus Renderer::status(const TickInput& in) const {
  if (!model_time_ || !in.touch_arrival) return sync::SampleStatus::kNone;
  if (fade_.lost()) return sync::SampleStatus::kStale;
  if (!in.map) return sync::SampleStatus::kHeld;
  const double age_s = sync::to_seconds(in.map->to_sim(in.now) - *model_time_);
  if (age_s == 0) return sync::SampleStatus::kExact;
  return age_s <= settings_.max_extrapolation_s ? sync::SampleStatus::kExtrapolated : sync::SampleStatus::kHeld;
}

void Renderer::fill_state(const TickInput& in, const Eigen::Vector3d& transient_N) {
  tool_state_t& m = out_.state;
  m.header.sim_time_ns = in.map ? std::max<std::int64_t>(0, sync::to_ns(in.map->to_sim(in.now))) : -1;
  m.device.position_m = to_vec3(device_.position);
  m.device.orientation = to_quat(device_.orientation);
  m.proxy.orientation = to_quat(force_method_.orientation());
  m.proxy.position_m = to_vec3(force_method_.position());
  m.device_velocity_m_s = to_vec3f(device_.velocity);
  m.proxy_velocity_m_s = to_vec3f(force_method_.velocity());
  m.device_spin_rad_s = to_vec3f(device_.spin);
  m.proxy_spin_rad_s = to_vec3f(force_method_.spin());
  m.force_N = to_vec3f(out_.force_N);
  m.torque_N_m = to_vec3f(out_.torque_N_m);
  m.transient_N = to_vec3f(transient_N);
  m.energy_J = static_cast<float>(safety_.energy_J());
  m.generated_J = static_cast<float>(std::min(passivity_.generated_J() + walls_.generated_J(), kMaxReported_J));
  m.injected_J = static_cast<float>(force_stage_.injected_J());
  m.coupling = static_cast<float>(std::min(passivity_.factor(), walls_.factor()));
  m.touch_status = static_cast<std::int8_t>(status(in));
  m.fade = static_cast<float>(force_scale());
  m.buttons = device_.buttons;
  impulses_.write_constraints(in.now, m.constraints);
  m.constraint_count = static_cast<std::int32_t>(m.constraints.size());
}

}  // namespace tactus::haptic
