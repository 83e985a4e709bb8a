#include "tests/haptic_node/support/trial.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <tactus/contact_event_t.hpp>
#include <tactus/tool_constraint_t.hpp>
#include <tactus/touch_applied_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "sync/degradation/operator_chain.h"
#include "sync/resampling/sample_status.h"
#include "tests/haptic_node/support/waves.h"
#include "tests/haptic_node/support/world.h"

namespace tactus::haptic::test {
namespace {

constexpr double kTool_m = 0.008, kStep_s = 1e-3;
// The body stands on a spring so that it can be pressed.
constexpr double kBodySpring_N_m = 500, kBodyDamper_N_s_m = 0.5;
// A failure and its return are judged for this time.
constexpr double kLoss_s = 0.4, kLost_s = 0.2;
constexpr double kApart_s = 0.2;
constexpr double kEnd_s = 0.3;  // after the last tap
// Until a transient has rung down to 10 mN, and its impulse has been returned.
double transients_s(const Settings& s) {
  return s.presentation_delay_s + std::log(std::max(1.0, s.transient_limit_N / 0.01)) / s.transient_decay_1_s + 0.5;
}

Vector3d place(double z) { return {0, 0, z}; }

MonotoneCubic path_of(const TrialDef& d) {
  std::vector<double> times;
  std::vector<Vector3d> places;
  const auto go = [&](double t, double z) { times.push_back(t), places.push_back(place(kTool_m + z)); };
  const double moving_s = d.period_s - d.hold_s;
  for (int k = 0; k < d.taps; ++k) {
    const double begin = k * d.period_s;
    go(begin, d.top_m), go(begin + 0.43 * moving_s, -d.depth_m);
    go(begin + 0.43 * moving_s + d.hold_s, -d.depth_m);
  }
  go(d.taps * d.period_s, d.top_m);
  return {times, places, MonotoneCubic::Ends::kRest};
}

sync::OperatorChain operators_of(const TrialDef& d) {
  if (d.force_operators.empty()) return {};
  const std::string rule = "<degrade modality=\"haptic\" stage=\"force\" " + d.force_operators + "/>";
  return {sync::parse_profile("<profile seed=\"3\">" + rule + "</profile>", "p.xml"), "haptic", {}, "force"};
}

class Trial {
 public:
  explicit Trial(const TrialDef& def)
      : def_(def),
        scene_(scene(kTool_m)),
        safety_(safety_limits(def.settings)),
        renderer_(scene_, 0, def.settings, safety_),
        operators_(operators_of(def)),
        hand_(path_of(def), false, def.hand) {
    hand_.begin(host_ms(0));
    if (def.relief_m > 0) renderer_.set_maps(waves(def.relief_m));
  }

  TrialResult run() {
    const double tick_s = 1 / def_.settings.rate_Hz;
    const double end_s = def_.taps * def_.period_s + kEnd_s + 1e-3 * def_.action_ms + (def_.hits ? transients_s(def_.settings) : 0);
    for (double t = 0; t < end_s; t += tick_s) {
      if (def_.failure == Failure::kStall && t >= def_.failure_s && !stalled_) stalled_ = true, t += def_.stall_s;
      while (world_steps_ * kStep_s <= t + 1e-12) step_world();
      tick(t);
      r_.rung_down = t >= quiet_from_s_;
    }
    return r_;
  }

 private:
  bool fails(Failure kind, double t, double for_s) const {
    return def_.failure == kind && t >= def_.failure_s && t < def_.failure_s + for_s;
  }
  // The impulse on the body up to time t: the force of a tick acts until the next one, or until the device drops it.
  double impulse_until(double t) {
    while (sent_.size() > 1 && sent_[1].time_s <= t) sent_.pop_front();
    if (sent_.empty() || t < sent_.front().time_s) return applied_N_s_;
    const SentForce& f = sent_.front();
    return f.impulse_N_s + f.force_N * std::clamp(t - f.time_s, 0.0, sync::to_seconds(Device::kWatchdog));
  }
  void step_world() {
    const double now_s = world_steps_ * kStep_s;
    const double total = impulse_until(now_s - 1e-3 * def_.action_ms), force_N = -(total - applied_N_s_) / kStep_s;
    applied_N_s_ = total;
    if (def_.mass_kg > 0) {
      v_ += kStep_s * (force_N - kBodySpring_N_m * z_ - kBodyDamper_N_s_m * v_) / def_.mass_kg;
      z_ += kStep_s * v_;
      body_N_s_ += force_N * kStep_s;
      body_J_ += force_N * v_ * kStep_s;
    }
    ++world_steps_;
    // As in the simulation, the next touch is another contact.
    const double height_m = proxy_z_ - kTool_m - z_;
    if (height_m < 1e-4) touched_ = true;
    if (def_.mass_kg == 0 && def_.margin_m > 0 && touched_ && height_m > 3e-4) touched_ = false, ++contact_;
    if (!fails(Failure::kModels, now_s, kLoss_s)) way_.push_back({now_s, model_now(now_s)});
  }
  touch_model_t model_now(double now_s) const {
    std::vector<touch_plane_t> planes;
    const double height_m = proxy_z_ - kTool_m - z_;
    double margin_m = def_.margin_m + def_.margin_s * std::abs(proxy_speed_m_s_);
    if (def_.mass_kg == 0 && now_s < late_until_s_) margin_m = std::max(margin_m, def_.margin_late_m);
    if (margin_m <= 0 || height_m <= margin_m) {
      auto p = plane(contact_, place(z_), Vector3d::UnitZ());
      p.stiffness_N_m = static_cast<float>(def_.stiffness_N_m);
      if (def_.mass_kg > 0) p.effective_mass_kg = static_cast<float>(def_.mass_kg);
      p.velocity_m_s = to_vec3f(place(v_));
      if (def_.relief_m > 0) add_map(p);
      planes.push_back(p);
    }
    touch_model_t m = model(1e3 * now_s, planes);
    touch_applied_t a{};
    a.contact_id = 7;
    a.impulse_N_s = to_vec3(place(body_N_s_));
    a.energy_J = body_J_;
    m.applied = {a};
    m.applied_count = 1;
    return m;
  }

  DeviceState read(double t) {
    DeviceState state = hand_.read(host_ms(1e3 * t));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    lost_ = fails(Failure::kDevice, t, kLost_s);
    state.lost = lost_;
    if (fails(Failure::kNotFinite, t, kLost_s)) state.position.z() = nan;
    return state;
  }

  std::vector<contact_event_t> hits(double t, double z) {
    const bool in = z < z_ + kTool_m;
    std::vector<contact_event_t> list;
    if (in && !was_in_ && def_.hits) {
      auto e = event(++events_, contact_event_t::HIT, 1e3 * t);
      e.approach_speed_m_s = static_cast<float>(std::abs(speed_m_s_));
      e.effective_mass_kg = static_cast<float>(def_.settings.device_mass_kg);
      list.push_back(e);
      quiet_from_s_ = t + transients_s(def_.settings);
    }
    was_in_ = in;
    return list;
  }

  void tick(double t) {
    const DeviceState state = read(t);
    const double z = hand_.read(host_ms(1e3 * t)).position.z();
    measure_motion(t, z);
    TickInput in;
    const bool stepped = def_.failure == Failure::kClock && t >= def_.failure_s;
    in.now = host_ms(1e3 * t - (stepped ? 1000 : 0));
    in.device = state;
    while (!way_.empty() && way_.front().first + 1e-3 * def_.delay_ms <= t + 1e-12) {
      used_ = way_.front().second;
      way_.pop_front();
      in.fresh = &used_;
    }
    // An intended delay: the messages themselves arrive at once.
    if (!fails(Failure::kModels, t, kLoss_s)) arrival_ = in.now;
    in.touch_arrival = arrival_;
    in.map = sync::TimeMap{sync::sim_time(0), host_ms(stepped ? -1000 : 0), 1};
    in.touch_delay = sync::Nanoseconds(def_.delay_ms * kMs);
    in.force_step_N = def_.force_step_N;
    if (!operators_.empty()) in.force_stage = &operators_;
    in.action_delay_s = 1e-3 * def_.action_ms;
    in.restarted = def_.failure == Failure::kRestart && t >= def_.failure_s && !restarted_;
    restarted_ = restarted_ || in.restarted;
    const auto events = hits(t, z);
    in.events = events;
    const TickOutput& out = renderer_.step(in);
    hand_.write(out.force_N);
    judge(t, out);
    sent_.push_back({t, impulse_N_s_, constraint_N_});
  }

  // The energy of the forces of the last tick.
  void measure_motion(double t, double z) {
    if (begun_) {
      // A stall is longer than the watchdog of the device; its first part is not resolved here.
      const bool gap = t - tick_s_ > sync::to_seconds(Device::kWatchdog);
      const double held_s = std::min(t - tick_s_, sync::to_seconds(Device::kWatchdog));
      if (!gap) hand_J_ += constraint_N_ * (z - z_hand_);
      if (!gap) measure_injected(z - z_hand_, t - tick_s_);
      impulse_N_s_ += constraint_N_ * held_s;
      r_.constraint_N_s += constraint_N_ * held_s;
      r_.hand_N_s += force_N_ * held_s;
      r_.received_N_s += std::max(std::abs(force_N_), std::abs(constraint_N_)) * held_s;
      speed_m_s_ = (z - z_hand_) / (t - tick_s_);
    }
    begun_ = true;
    z_hand_ = z;
    tick_s_ = t;
    // Both ports: positive energy to the hand, and to the body.
    const double out_J = hand_J_ - hand_before_J_ + body_J_ - body_before_J_;
    // The state holds the transient in single precision. A surface that no model has reported yet is in no contact: the
    // hand passes it without a force, also for longer than an episode lasts.
    const bool apart = std::abs(constraint_N_) < 1e-6 && (z >= z_ + kTool_m || used_.planes.empty());
    if (!apart) apart_from_s_ = t;
    // A hand that was inside when touch returned takes the energy of the springs with it.
    inside_ = restarts_at(t) || (inside_ && t - apart_from_s_ <= kApart_s);
    if (t - apart_from_s_ > kApart_s - 2 / def_.settings.rate_Hz || inside_) {
      hand_before_J_ = hand_J_, body_before_J_ = body_J_;
    } else {
      r_.generated_mJ = std::max(r_.generated_mJ, 1e3 * out_J);
    }
    r_.energy_mJ = 1e3 * hand_J_;
    r_.body_N_s = body_N_s_;
  }
  // Energy that the stage `force` adds: with transients, and without the part that the damping of the device dissipates.
  void measure_injected(double moved_m, double dt) {
    silent_s_ = force_N_ == 0 && constraint_N_ == 0 ? silent_s_ + dt : 0;
    if (silent_s_ > kApart_s) displayed_J_ = computed_J_ = max_computed_J_ = 0;
    displayed_J_ += force_N_ * moved_m - def_.settings.device_damping_Ns_m * moved_m * moved_m / dt;
    computed_J_ += constraint_N_ * moved_m;
    max_computed_J_ = std::max(max_computed_J_, computed_J_);
    r_.injected_mJ = std::max(r_.injected_mJ, 1e3 * (displayed_J_ - max_computed_J_));
  }
  // Touch begins or returns: the hand may then be inside, without having done work.
  bool restarts_at(double t) const {
    const double after_s = t - def_.failure_s;
    return def_.failure != Failure::kNone && after_s >= 0 &&
           after_s < kLoss_s + def_.stall_s + 2 * def_.settings.fade_s + def_.settings.stale_after_s + 0.1;
  }

  void judge(double t, const TickOutput& out) {
    const Settings& s = def_.settings;
    const double force = out.force_N.z();
    r_.finite = r_.finite && out.force_N.allFinite() && out.torque_N_m.allFinite();
    r_.peak_N = std::max(r_.peak_N, std::abs(force));
    r_.beyond_force_N = std::max(r_.beyond_force_N, out.force_N.norm() - s.force_limit_N);
    const bool gap = t - judged_s_ > sync::to_seconds(Device::kWatchdog);
    const double dt = gap ? 1 / s.rate_Hz : t - judged_s_;
    const Vector3d last_N = gap ? Vector3d(Vector3d::Zero()) : last_force_N_;
    r_.beyond_rise_N =
        std::max(r_.beyond_rise_N, beyond_slew_N(out.force_N, last_N, s.slew_limit_N_s * std::min(dt, 2 / s.rate_Hz)));
    last_force_N_ = out.force_N;
    r_.beyond_fade_N = std::max(r_.beyond_fade_N, std::abs(force) - fade_limit_N(t));
    r_.observed_mJ = std::max(r_.observed_mJ, 1e3 * out.state.generated_J);
    r_.least_coupling = std::min<double>(r_.least_coupling, out.state.coupling);
    judge_last_tap(t, force);
    if (out.state.touch_status >= static_cast<std::int8_t>(sync::SampleStatus::kHeld)) late_until_s_ = t + 1;
    force_N_ = force;
    constraint_N_ = force - out.state.transient_N.z;
    if (!operators_.empty()) {
      constraint_N_ = 0;
      for (const tool_constraint_t& c : out.state.constraints) constraint_N_ += c.force_N.z;
    }
    judged_s_ = t;
    const double before_m = proxy_z_;
    proxy_z_ = out.state.proxy.position_m.z;
    proxy_speed_m_s_ = begun_ ? (proxy_z_ - before_m) * s.rate_Hz : 0;
  }
  void judge_last_tap(double t, double force_N) {
    const double begin_s = (def_.taps - 1) * def_.period_s;
    const double depth_m = z_ + kTool_m - z_hand_;
    if (t < begin_s) return;
    r_.last_peak_N = std::max(r_.last_peak_N, force_N);
    r_.deepest_m = std::max(r_.deepest_m, depth_m);
    if (t > begin_s + 0.43 * (def_.period_s - def_.hold_s) + def_.hold_s) return;
    r_.hold_N = force_N, r_.hold_m = depth_m;
  }
  // The largest force that the fade of a failure and of the return allow at time t, N. Two ticks are left for the
  // discrete time.
  double fade_limit_N(double t) const {
    const Settings& s = def_.settings;
    const double since_s = t - def_.failure_s, spare_s = 2 / s.rate_Hz, max_N = s.force_limit_N;
    const auto share = [](double x) { return std::clamp(x, 0.0, 1.0); };
    // Factor of a loss from begins_s to ends_s.
    const auto lost = [&](double begins_s, double ends_s) {
      const double fallen = share(1 - (std::min(since_s, ends_s) - begins_s - spare_s) / s.fade_s);
      return share(fallen + std::max(0.0, (since_s - ends_s + spare_s) / s.fade_s));
    };
    if (since_s < 0) return max_N;
    switch (def_.failure) {
      case Failure::kNone: return max_N;
      case Failure::kModels: return max_N * lost(s.stale_after_s, kLoss_s);
      case Failure::kDevice:
      case Failure::kNotFinite: return max_N * lost(0, kLost_s);
      case Failure::kStall:
        return def_.stall_s > sync::to_seconds(Device::kWatchdog) + spare_s ? max_N * lost(-1e9, def_.stall_s) : max_N;
      case Failure::kRestart: {
        const double before = share(def_.failure_s / s.fade_s), fall_s = before * s.fade_s;
        return max_N * (since_s < fall_s ? share(before - (since_s - spare_s) / s.fade_s)
                                         : share((since_s - fall_s + spare_s) / s.fade_s));
      }
      case Failure::kClock: return max_N * lost(-1e9, 0);
    }
    return max_N;
  }

  const TrialDef& def_;
  scene_t scene_;
  Safety safety_;
  Renderer renderer_;
  sync::OperatorChain operators_;
  VirtualHand hand_;
  TrialResult r_;
  std::deque<std::pair<double, touch_model_t>> way_;
  struct SentForce {
    double time_s, impulse_N_s, force_N;  // impulse up to the tick, and force from it on
  };
  std::deque<SentForce> sent_;  // to the body, from the newest that has reached it on
  touch_model_t used_{};
  std::optional<sync::HostTime> arrival_;
  int world_steps_ = 0;
  std::int64_t events_ = 0, contact_ = 7;
  double z_ = 0, v_ = 0, body_N_s_ = 0, body_J_ = 0, applied_N_s_ = 0;  // of the body
  double z_hand_ = 0, speed_m_s_ = 0, hand_J_ = 0, hand_before_J_ = 0, body_before_J_ = 0;
  double tick_s_ = 0, judged_s_ = 0, apart_from_s_ = 0, impulse_N_s_ = 0;
  Vector3d last_force_N_ = Vector3d::Zero();
  double force_N_ = 0, constraint_N_ = 0, quiet_from_s_ = 0;
  double displayed_J_ = 0, computed_J_ = 0, max_computed_J_ = 0, silent_s_ = 0;  // of measure_injected()
  double proxy_z_ = 1, proxy_speed_m_s_ = 0;
  double late_until_s_ = -1;  // the tool has rendered a late model shortly before
  bool begun_ = false, was_in_ = false, touched_ = false, stalled_ = false, restarted_ = false, lost_ = false, inside_ = false;
};

}  // namespace

TrialResult run_trial(const TrialDef& def) { return Trial(def).run(); }

TrialDef metronome() {
  TrialDef d;
  d.taps = 24;
  // As sim_node reports planes (its settings touch_margin and touch_margin_time).
  d.margin_m = 0.008, d.margin_s = 0.03, d.margin_late_m = 0.1;
  return d;
}

TrialDef press() {
  TrialDef d = metronome();
  d.taps = 2;
  // The way down takes 0.43 of the time that is not held.
  d.period_s = 3, d.hold_s = 2.3;
  d.depth_m = 0.013;
  return d;
}

}  // namespace tactus::haptic::test
