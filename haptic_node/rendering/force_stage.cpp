#include "haptic_node/rendering/force_stage.h"

#include <algorithm>

#include "haptic_node/rendering/limits_of_settings.h"

namespace tactus::haptic {

ForceStage::ForceStage(const Settings& settings) : injected_(injected_limits(settings)) {}

void ForceStage::change(const Settings& settings) {
  injected_.change(injected_limits(settings));
  if (reaction_) reaction_->set_limits(safety_limits(settings));
}

void ForceStage::restart() {
  signal_.clear();
  injected_.reset();
  reaction_commands_.clear();
}

void ForceStage::begin_tick(sync::HostTime now, sync::SimTime world, sync::OperatorChain* operators,
                            sync::Decisions* decisions, const Safety& safety, const ForceHistory& commands) {
  const bool degrades = operators && !operators->empty();
  operators_ = operators;
  decisions_ = decisions;
  now_ = now;
  world_ = world;
  if (degrades && !reaction_) {
    restart();
    reaction_ = safety;
    reaction_commands_ = commands;
  }
  if (!degrades) reaction_.reset();
  if (reaction_) reaction_->begin_tick(now);
}

void ForceStage::observe(double stored_J, const DeviceMotion& motion, const ForceHistory& commands, double dt) {
  const double now_s = sync::to_seconds(now_.time_since_epoch());
  injected_.observe(acting_in_tick(commands, now_s, dt, motion.loop), acting_in_tick(reaction_commands_, now_s, dt, motion.loop),
                    motion, motion.loop.immediate() ? dt : motion.loop.span_s, stored_J, dt);
}

Wrench ForceStage::display(const Wrench& wanted, const Wrench& reaction, const Eigen::Vector3d& transient_N, double share,
                           const DeviceMotion& motion, double dt) {
  const bool valid = wanted.force_N.allFinite() && wanted.torque_N_m.allFinite() && transient_N.allFinite() && share > 0;
  const sync::ForceSample sample =
      valid ? sync::ForceSample{wanted.force_N, wanted.torque_N_m, transient_N, share} : sync::ForceSample{};
  sync::ForceSample shown = signal_.step(now_, world_, sample, *operators_, decisions_);
  // A force from before a loss must not outlive it.
  const double kept = std::clamp(share / shown.share, 0.0, 1.0);
  shown.force_N *= kept;
  shown.torque_N_m *= kept;
  shown.transient_N *= kept;
  const bool same = shown.force_N == sample.force_N && shown.torque_N_m == sample.torque_N_m;
  const double held_s = motion.loop.immediate() ? dt : std::max(dt, motion.loop.period_s);
  const double braked = injected_.brake({shown.force_N, shown.torque_N_m}, reaction, same, held_s);
  transient_N_ = braked * shown.transient_N;
  return {braked * shown.force_N, braked * shown.torque_N_m};
}

void ForceStage::delay(std::vector<presentation_t>& reports) const {
  if (!active()) return;
  const std::int64_t delay_ns = operators_->constant_delay(world_).count();
  const bool cut_off = operators_->cuts_off(world_);
  for (presentation_t& r : reports) {
    if (r.outcome != presentation_t::PRESENTED && r.outcome != presentation_t::LATE) continue;
    if (cut_off) {
      r.outcome = presentation_t::DROPPED_BY_PROFILE;
      r.scheduled_ns = r.presented_ns = -1;
      continue;
    }
    for (std::int64_t* at_ns : {&r.scheduled_ns, &r.presented_ns})
      if (*at_ns >= 0) *at_ns += delay_ns;
  }
}

}  // namespace tactus::haptic
