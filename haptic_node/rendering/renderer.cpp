#include "haptic_node/rendering/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <tactus/material_def_t.hpp>
#include <utility>

#include "haptic_node/contact/rotation_math.h"
#include "haptic_node/rendering/force_steps.h"
#include "haptic_node/rendering/limits_of_settings.h"
#include "haptic_node/rendering/rigid_coupling.h"
#include "lcmtypes/vectors.h"

namespace tactus::haptic {
namespace {

// Time until a hand that was inside when touch began presses a surface: a touch model, and two in reserve.
constexpr double kFirstPress_s = 0.003;

// Keeps the largest forces, up to the number that a message holds; the shares of the others go to these.
void keep_largest(std::span<Eigen::Vector3d> forces) {
  if (forces.size() <= ContactImpulses::kMaxPublished || forces.size() > kMaxHalfSpaces) return;
  std::array<double, kMaxHalfSpaces> sizes;
  for (std::size_t i = 0; i < forces.size(); ++i) sizes[i] = forces[i].squaredNorm();
  const auto last = sizes.begin() + ContactImpulses::kMaxPublished - 1;
  std::nth_element(sizes.begin(), last, sizes.begin() + static_cast<std::ptrdiff_t>(forces.size()),
                   std::greater<>());
  std::size_t kept = 0;
  for (Eigen::Vector3d& f : forces)
    if (f.squaredNorm() < *last || (!f.isZero(0) && ++kept > ContactImpulses::kMaxPublished)) f.setZero();
}

}  // namespace

Renderer::Renderer(const scene_t& scene, int tool, const Settings& settings, Safety& safety)
    : tool_(tool),
      tool_body_(scene.tools[static_cast<std::size_t>(tool)].body),
      settings_(settings),
      coupling_(coupling_limits(settings)),
      period_s_(1 / settings.rate_Hz),
      step_s_(static_cast<double>(scene.step_ns) * 1e-9),
      surfaces_(skin_m(scene.tools[static_cast<std::size_t>(tool)]), surface_limits(settings)),
      reliefs_(reliefs_of(settings)),
      force_method_(scene.tools[static_cast<std::size_t>(tool)], settings),
      force_crossfade_(settings.recovery_time_s, settings.recovery_speed_m_s * settings.stiffness_limit_N_m),
      torque_crossfade_(settings.recovery_time_s,
                        settings.recovery_speed_m_s * settings.stiffness_limit_N_m * force_method_.lever_m()),
      passivity_(passivity_limits(settings, step_s_)),
      walls_(wall_limits(settings)),
      transients_(transient_shape(settings)),
      safety_(safety),
      force_stage_(settings),
      fade_(settings.stale_after_s, settings.fade_s) {
  for (const material_def_t& m : scene.materials) youngs_modulus_Pa_.push_back(m.youngs_modulus_Pa);
  forces_.reserve(kMaxHalfSpaces);
  arms_.reserve(kMaxHalfSpaces);
  felt_.reserve(kMaxHalfSpaces);
  out_.reports.reserve(256);
  out_.state.tool = tool;
  out_.state.constraints.reserve(ContactImpulses::kMaxPublished);
}

void Renderer::change(const Settings& settings) {
  settings_ = settings;
  transients_.change(transient_shape(settings));
  reliefs_.change(reliefs_of(settings));
  if (force_method_.change(settings)) {
    for (Surface& s : surfaces_.list()) {
      s.grip.setZero();
      s.stick_error.setZero();
      s.slipping = false;
    }
    force_crossfade_.restart();
    torque_crossfade_.restart();
  }
  passivity_.change(passivity_limits(settings, step_s_));
  walls_.change(wall_limits(settings));
  force_stage_.change(settings);
}

void Renderer::update_device(const TickInput& in) {
  DeviceState device = in.device;
  if (!device.position.allFinite() || !device.velocity.allFinite() || !device.orientation.coeffs().allFinite() ||
      !device.spin.allFinite()) {
    device = device_;
    device.lost = true;
  }
  if (!started_) {
    started_ = true;
    last_ = in.now - sync::from_seconds(period_s_);
    device_ = device;
    device_share_ = device.lost ? 0 : 1;
    begin_touch();
    force_method_.reset(device);
  }
  if (device.lost) {
    device.velocity.setZero();
    device.spin.setZero();
  }
  motion_ = {device.position - device_.position, rotation_between(device_.orientation, device.orientation), device.loop};
  device_ = device;
}

void Renderer::restart_touch() {
  device_share_ = 0;
  motion_ = {};
  motion_.loop = device_.loop;
  commands_.clear();
  force_stage_.restart();
  passivity_.drop_commands();
  walls_.reset();
  force_crossfade_.reset();
  torque_crossfade_.reset();
  transients_.stop();
  felt_transient_N_.setZero();
}

void Renderer::update_surfaces(const TickInput& in, double dt) {
  // A lost device may return anywhere: touch restarts there.
  const bool away = device_share_ <= 0;
  device_share_ = std::clamp(device_share_ + (device_.lost ? -1 : 1) * dt / settings_.fade_s, 0.0, 1.0);
  if (in.restarted) fade_.restart();
  const bool silent = fade_.step(in.now, in.touch_arrival, dt) <= 0 || away || device_share_ <= 0;
  if (silent) {
    // Surfaces that arrive after the loss are new.
    surfaces_.clear();
    force_method_.reset(device_);
    begin_touch();
  }
  // While the force of the previous world fades, its surfaces remain.
  const TouchModelView fresh = fade_.restarting() ? TouchModelView{} : in.fresh;
  if (fresh) model_time_ = sync::sim_time(fresh.header().sim_time_ns);
  const double age_s = model_time_ && in.map ? sync::to_seconds(in.map->to_sim(in.now) - *model_time_) : 0;
  model_age_s_ = age_s;
  // Otherwise the loop delay would contain, for seconds, a delay that the profile has already removed.
  const auto before = std::exchange(touch_delay_, in.touch_delay);
  if (in.touch_delay < before) loop_delay_.reduce(sync::to_seconds(before - in.touch_delay));
  loop_delay_.advance(age_s, dt);
  if (fresh) {
    loop_delay_.observe(age_s);
    passivity_.on_message(fresh);
  }
  const auto sim_now = in.map ? std::optional(in.map->to_sim(in.now - in.touch_delay)) : std::nullopt;
  if (fresh) force_method_.reset_reach(device_);
  // While touch begins or returns, surfaces rise to the hand. Later, one that would need more than the allowance is held.
  constexpr double kAny = std::numeric_limits<double>::infinity();
  const bool begins = returning_s_ > 0;
  surfaces_.set_rise(begins ? kAny : std::sqrt(2 * settings_.generated_limit_J / settings_.stiffness_limit_N_m),
                     begins ? kAny : walls_.headroom_J());
  surfaces_.set_orientation(force_method_.tool_orientation(device_));
  surfaces_.step(fresh, sim_now, force_method_.position(), dt, force_method_.planes(in.planes));
}

Gains Renderer::gains(const Surface& s) const {
  // A state that is held for the period of the device is late by half of it.
  const double delay_s = device_.loop.delay_s, device_s = delay_s + (hold_s() - period_s_) / 2;
  double stiffness_N_m = s.stiffness_N_m;
  if (!device_.loop.immediate() && force_method_.renders_torque())
    stiffness_N_m =
        std::min(stiffness_N_m, turning_limit_N_m(settings_, force_method_.lever_m(), hold_s(), delay_s));
  return coupling_gains(stiffness_N_m, s.damping_N_s_m, s.effective_mass_kg,
                        loop_delay_.value_s(step_s_, period_s_) + hold_of_push_s(settings_.rate_Hz, step_s_) + device_s +
                            action_delay_s_,
                        hold_s(), coupling_, delay_s);
}

Wrench Renderer::constraint_wrench(double force_step_N, double dt, double held_s) {
  const double follow = 1 - std::exp(-dt / settings_.recovery_time_s);
  for (Surface& s : surfaces_.list()) {
    const Gains g = gains(s);
    if (s.coupling_stiffness_N_m < 0) s.coupling_stiffness_N_m = g.stiffness_N_m;
    s.coupling_stiffness_N_m += follow * (g.stiffness_N_m - s.coupling_stiffness_N_m);
    s.coupling_damping_N_s_m = g.damping_N_s_m;
  }
  forces_.assign(surfaces_.list().size(), Eigen::Vector3d::Zero());
  reliefs_.apply_heights(surfaces_.list(), force_method_.tool_pose(), dt);
  double relief_J = Reliefs::half_energy_of_heights(surfaces_.list());
  force_method_.solve(surfaces_.list(), device_, dt);
  relief_J += Reliefs::half_energy_of_heights(surfaces_.list());
  const StoredEnergy bodies = force_method_.stored_energy(surfaces_.list());
  // The forces of the hand reach the bodies, and their reports, later by the stage `action`.
  passivity_.observe(bodies, motion_.moved_m, motion_.turned_rad, model_age_s_ + action_delay_s_, held_s, motion_.loop);
  const StoredEnergy walls = force_method_.stored_energy(surfaces_.list(), ForceMethod::Partner::kWalls);
  stored_J_ = bodies.energy_J + walls.energy_J;
  if (!walls.pressed && since_begin_s_ > kFirstPress_s + 3 * period_s_) returning_s_ = 0;
  since_begin_s_ += dt;
  const double appeared_J = returning_s_ > 0 ? walls.appeared_J : 0;
  const double rounded = force_step_N > 0 ? rounded_share_ : 1;
  walls_.observe(rounded * walls.energy_J, walls.pressed, motion_, held_s, rounded * appeared_J, rounded * relief_J);
  returning_s_ -= dt;
  force_method_.compute_forces(surfaces_.list(), device_, {passivity_.factor(), walls_.factor()}, forces_);
  reliefs_.tilt_forces(surfaces_.list(), force_method_.tool_pose(), forces_);
  const Wrench sum = force_method_.sum(surfaces_.list(), forces_);
  return {force_crossfade_.step(surfaces_.list(), sum.force_N, dt),
          torque_crossfade_.step(surfaces_.list(), sum.torque_N_m, dt)};
}

Hit Renderer::hit_of(const contact_event_t& e, sync::HostTime scheduled) const {
  const bool tool_is_b = e.body_b == tool_body_;
  const std::int32_t material = tool_is_b ? e.material_a : e.material_b;
  Hit hit;
  hit.event_id = e.event_id;
  hit.scheduled = scheduled;
  hit.direction = (tool_is_b ? 1 : -1) * to_eigen(e.normal).normalized();  // away from the hit body
  hit.approach_speed_m_s = e.approach_speed_m_s;
  hit.effective_mass_kg = std::min<double>(e.effective_mass_kg, settings_.device_mass_kg);
  if (material >= 0 && material < static_cast<std::int32_t>(youngs_modulus_Pa_.size()))
    hit.youngs_modulus_Pa = youngs_modulus_Pa_[static_cast<std::size_t>(material)];
  return hit;
}

void Renderer::handle_events(const TickInput& in) {
  if (!in.map) return;
  for (const contact_event_t& e : in.events) {
    if (e.tool != tool_) continue;
    const sync::HostTime happened = in.map->to_host(sync::sim_time(e.time_ns));
    if (e.kind == contact_event_t::HIT)
      transients_.schedule(
          hit_of(e, happened + sync::from_seconds(settings_.presentation_delay_s) + in.transient_delay),
          out_.reports);
    if (e.kind == contact_event_t::BEGIN)
      pending_onsets_.add(e.event_id, e.contact_id, happened, in.now, out_.reports);
  }
}

// The part of the constraint that fixed surfaces give. A crossfade from other surfaces is shared by magnitude.
WallForce Renderer::force_of_walls(const Wrench& constraint) {
  const auto list = surfaces_.list();
  arms_.clear();
  if (force_method_.renders_torque())
    for (const Surface& s : list) arms_.push_back(force_method_.arm(s));
  WallForce walls = wall_force(list, forces_, arms_);
  const Wrench sum = force_method_.sum(list, forces_);
  double walls_N = 0, all_N = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    all_N += forces_[i].norm();
    if (!list[i].movable()) walls_N += forces_[i].norm();
  }
  if (!(walls_N > 0)) return {};
  walls.wrench.force_N += walls_N / all_N * (constraint.force_N - sum.force_N);
  walls.wrench.torque_N_m += walls_N / all_N * (constraint.torque_N_m - sum.torque_N_m);
  return walls;
}

// Applies the limits of safety. The energy account pairs the motion with the force that acted during it.
Wrench Renderer::limited(const Wrench& wanted, double dt, ForceOutput to) {
  const double now_s = sync::to_seconds(last_.time_since_epoch());
  const DeviceLoop& loop = motion_.loop;
  // The force of the previous scene acts until the first command of this one.
  if (to.commands.empty()) to.commands.record(std::numeric_limits<double>::lowest(), to.safety.released());
  if (!loop.immediate())
    to.safety.set_acting(acting_in_tick(to.commands, now_s, dt, loop), std::max(loop.span_s, dt));
  const Wrench command = to.safety.limit(wanted, motion_.moved_m, motion_.turned_rad, dt);
  to.commands.record(now_s, command);
  return command;
}

Renderer::Commanded Renderer::output(const Wrench& wanted, double scale, const Eigen::Vector3d& transient_N, double dt) {
  const ForceOutput hand{safety_, commands_};
  const bool staged = force_stage_.active();
  if (staged) force_stage_.observe(stored_J_, motion_, commands_, dt);
  const ForceOutput bodies = staged ? force_stage_.bodies() : hand;
  const Wrench all = limited(wanted, dt, bodies);
  const Wrench& released = bodies.safety.released();
  const Eigen::Vector3d own_N = all.force_N - released.force_N;
  const double wanted_N = wanted.force_N.norm();
  const Eigen::Vector3d felt_N = wanted_N > 0 ? own_N.norm() / wanted_N * scale * transient_N : own_N;
  const Commanded given{{own_N - felt_N, all.torque_N_m - released.torque_N_m}, felt_N};
  Wrench displayed = all;
  shown_transient_N_ = felt_N;
  if (staged) {
    const Wrench shown = force_stage_.display(wanted, all, scale * transient_N, force_scale(), motion_, dt);
    displayed = limited(shown, dt, hand);
    const double shown_N = shown.force_N.norm();
    const double kept = shown_N > 0 ? (displayed.force_N - safety_.released().force_N).norm() / shown_N : 0;
    shown_transient_N_ = kept * force_stage_.transient_N();
  }
  out_.force_N = displayed.force_N;
  out_.torque_N_m = displayed.torque_N_m;
  return given;
}

// Everything that changes the force acts on constraint and transient in one proportion, so that the bodies receive
// exactly the constraint that the hand feels.
Renderer::Commanded Renderer::command(Wrench constraint, Eigen::Vector3d transient_N, double force_step_N, double dt) {
  WallForce walls = force_of_walls(constraint);
  // The fade acts on the rounded force within its limit. Otherwise a strong or a rounded one would return almost at once.
  const Eigen::Vector3d plain = constraint.force_N + transient_N;
  const double all_N = plain.norm();
  const double share = all_N > settings_.force_limit_N ? settings_.force_limit_N / all_N : 1;
  constraint = {share * constraint.force_N, share * constraint.torque_N_m};
  transient_N *= share;
  const double rounded_N = std::min(quantised(share * plain, force_step_N).norm(), settings_.force_limit_N);
  rounded_share_ = rounded_energy(share * all_N, rounded_N);
  const double scale = all_N > 0 ? force_scale() * rounded_N / (share * all_N) : 0;
  const auto scaled = [](const Wrench& w, double force, double torque) {
    return Wrench{force * w.force_N, torque * w.torque_N_m};
  };
  const Wrench of_walls = scaled(walls.wrench, share, share), tilt = scaled(walls.tilt, share, share);
  walls = {scaled(of_walls, scale, force_scale()), scaled(tilt, scale, force_scale()), scale * share * walls.power_W};
  const double kept = walls_.brake(walls, motion_, dt);
  if (kept < 1) {
    constraint.force_N -= (1 - kept) * of_walls.force_N;
    constraint.torque_N_m -= (1 - kept) * of_walls.torque_N_m;
    for (std::size_t i = 0; i < forces_.size(); ++i)
      if (!surfaces_.list()[i].movable()) forces_[i] *= kept;
    // A transient that the walls opposed may now be stronger than before.
    const double left_N = scale * (constraint.force_N + transient_N).norm();
    const double within = std::min(1.0, force_scale() * settings_.force_limit_N / std::max(left_N, 1e-12));
    constraint = {within * constraint.force_N, within * constraint.torque_N_m};
    transient_N *= within;
  }
  const Wrench wanted{scale * (constraint.force_N + transient_N), force_scale() * constraint.torque_N_m};
  return output(wanted, scale, transient_N, dt);
}

// Splits the constraint force that remains after all limits over the surfaces, so that the bodies feel exactly the
// force that the hand feels.
void Renderer::distribute(const Wrench& felt_constraint) {
  const auto list = surfaces_.list();
  const bool any = std::any_of(forces_.begin(), forces_.end(), [](const auto& f) { return f.norm() > 0; });
  felt_.clear();
  if (!any) return;
  keep_largest(forces_);
  force_method_.distribute(felt_constraint, list, forces_);
  for (std::size_t i = 0; i < list.size(); ++i) {
    felt_.push_back({list[i].contact_id, list[i].body, Eigen::Vector3d::Zero(), forces_[i]});
    if (!forces_[i].isZero(0)) felt_.back().point = force_method_.tool_pose().contact_point(list[i]);
  }
}

TickOutput& Renderer::step(const TickInput& in) {
  out_.reports.clear();
  update_device(in);
  // Beyond the watchdog time no force was applied, and the clock may have stepped.
  const sync::Nanoseconds passed = in.now - last_;
  const bool gap = passed > Device::kWatchdog || passed < -Device::kWatchdog;
  const double held_s = sync::to_seconds(std::clamp(passed, sync::Nanoseconds(1000), Device::kWatchdog));
  const double dt = gap ? period_s_ : held_s;
  transients_.add_felt_impulse(held_s * felt_transient_N_);
  if (gap) restart_touch();
  const sync::SimTime world = in.map ? in.map->to_sim(in.now) : sync::SimTime{};
  force_stage_.begin_tick(in.now, world, in.force_stage, in.force_decisions, safety_, commands_);
  action_delay_s_ = in.action_delay_s;
  safety_.begin_tick(in.now);
  last_ = in.now;

  update_surfaces(in, dt);
  handle_events(in);
  const Wrench constraint = constraint_wrench(in.force_step_N, dt, held_s);
  const bool felt = force_scale() > 0;
  const Eigen::Vector3d transient = transients_.step(in.now, period_s_, felt, uncertainty(), out_.reports);
  if (!device_.lost) {
    safety_.set_position(device_.position);
    force_stage_.set_position(device_.position);
  }
  const Commanded commanded = command(constraint, transient, in.force_step_N, dt);
  felt_transient_N_ = commanded.transient_N;
  distribute(commanded.constraint);
  impulses_.step(in.now, held_s, felt_);
  const Eigen::Vector3d* const about = force_method_.renders_torque() ? &force_method_.position() : nullptr;
  passivity_.record(felt_, surfaces_.list(), about);
  walls_.record(wall_force(surfaces_.list(), forces_, arms_));
  const auto known = [this](std::int64_t contact) { return surfaces_.find(contact) != nullptr; };
  const auto shown = in.map && model_time_ ? std::optional(in.map->to_host(*model_time_)) : std::nullopt;
  pending_onsets_.step({in.now, shown, in.touch_delay, uncertainty(), known}, impulses_, out_.reports);
  force_stage_.delay(out_.reports);
  fill_state(in, shown_transient_N_);
  return out_;
}

}  // namespace tactus::haptic
