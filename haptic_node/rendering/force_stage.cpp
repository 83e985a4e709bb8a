#include "haptic_node/rendering/force_stage.h"

#include <algorithm>

#include "haptic_node/rendering/limits_of_settings.h"

namespace tactus::haptic {
namespace {

constexpr double kEpisodeGap_s = 0.2;  // as in injected_energy.cpp

bool no_wrench(const Wrench& w) { return w.force_N.isZero(0) && w.torque_N_m.isZero(0); }

}  // namespace

ForceStage::ForceStage(const Settings& settings) : limits_(safety_limits(settings)), injected_(injected_limits(settings)) {}

void ForceStage::change(const Settings& settings) {
  limits_ = safety_limits(settings);
  injected_.change(injected_limits(settings));
  if (reaction_) reaction_->set_limits(safety_limits(settings));
}

void ForceStage::restart() {
  signal_.clear();
  injected_.reset();
  reaction_commands_.clear();
  tdpa_.reset();
  released_J_ = motion_s_ = apart_s_ = 0;
  same_ = true;
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
  const Wrench displayed = acting_in_tick(commands, now_s, dt, motion.loop);
  const Wrench computed = acting_in_tick(reaction_commands_, now_s, dt, motion.loop);
  const double span_s = motion.loop.immediate() ? dt : motion.loop.span_s;
  injected_.observe(displayed, computed, motion, span_s, stored_J, dt);
  observe_tdpa(displayed, computed, motion, span_s, dt);
}

void ForceStage::observe_tdpa(const Wrench& displayed, const Wrench& computed, const DeviceMotion& motion, double span_s, double dt) {
  const bool controls = operators_->passivity(world_) == sync::Passivity::kTdpa;
  if (controls && !controls_) {
    // The packets on their way promise nothing.
    tdpa_.begin(released_J_);
    same_ = true;
  }
  controls_ = controls;
  apart_s_ = no_wrench(displayed) && no_wrench(computed) ? apart_s_ + dt : 0;
  if (apart_s_ > kEpisodeGap_s) {
    tdpa_.forget_credit();
    same_ = true;
  }
  if (!(span_s > 0)) return;
  motion_ = motion, motion_s_ = span_s;
  if (controls_) tdpa_.observe(work_J(displayed, motion, span_s));
  released_J_ += std::max(0.0, work_J(computed, motion, span_s));
}

// As in Renderer::command: while touch fades or returns, an amplified or predicted force stays within its share of the limits.
void ForceStage::limit_to_share(sync::ForceSample& shown, double share) const {
  const double force_N = shown.force_N.norm(), torque_N_m = shown.torque_N_m.norm();
  const double kept = std::min({1.0, share * limits_.force_N / std::max(force_N, 1e-12), share * limits_.torque_N_m / std::max(torque_N_m, 1e-12)});
  shown.force_N *= kept;
  shown.torque_N_m *= kept;
  shown.transient_N *= kept;
}

// The motion until the device applies the next force, if the hand continues as it moved last.
DeviceMotion ForceStage::expected_motion(double held_s) const {
  const double scale = motion_s_ > 0 ? held_s / motion_s_ : 0;
  return {scale * motion_.moved_m, scale * motion_.turned_rad, motion_.loop};
}

Wrench ForceStage::display(const Wrench& wanted, const Wrench& reaction, const Eigen::Vector3d& transient_N, double share,
                           const DeviceMotion& motion, double dt) {
  const bool valid = wanted.force_N.allFinite() && wanted.torque_N_m.allFinite() && transient_N.allFinite() && share > 0;
  const double held_s = motion.loop.immediate() ? dt : std::max(dt, motion.loop.period_s);
  const DeviceMotion during = expected_motion(held_s);
  const double energy_J = released_J_ + TimeDomainPassivity::given_J(reaction, during, held_s);
  const double speed_m_s = motion_s_ > 0 && motion_.moved_m.allFinite() ? motion_.moved_m.norm() / motion_s_ : 0;
  const sync::ForceSample sample =
      valid ? sync::ForceSample{wanted.force_N, wanted.torque_N_m, transient_N, share, energy_J, speed_m_s} : sync::ForceSample{};
  sync::ForceSample shown = signal_.step(now_, world_, sample, *operators_, decisions_);
  // A force from before a loss must not outlive it.
  const double kept = std::clamp(share / shown.share, 0.0, 1.0);
  shown.force_N *= kept;
  shown.torque_N_m *= kept;
  shown.transient_N *= kept;
  const bool same = shown.force_N == sample.force_N && shown.torque_N_m == sample.torque_N_m;
  if (!same && share < 1) limit_to_share(shown, share);
  same_ = same_ && same;
  Wrench passive{shown.force_N, shown.torque_N_m};
  if (controls_ && !same_) passive = tdpa_.control(passive, during, held_s, shown.energy_J);
  const double braked = injected_.brake(passive, reaction, same && (!controls_ || same_), held_s);
  transient_N_ = braked * shown.transient_N;
  return {braked * passive.force_N, braked * passive.torque_N_m};
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
