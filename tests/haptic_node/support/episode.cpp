#include "tests/haptic_node/support/episode.h"

#include <chrono>
#include <cmath>
#include <deque>
#include <random>
#include <tactus/tool_constraint_t.hpp>
#include <tactus/touch_applied_t.hpp>
#include <tactus/touch_model_t.hpp>

#include "tests/haptic_node/support/episode_world.h"

namespace tactus::haptic::test {
namespace {

// The hand waits, so that the renderer has measured the network before the first touch.
constexpr double kWait_s = 1;
constexpr int kHold_ms = 3800, kEnd_ms = 5000, kJudged_ms = 500, kApart_ms = 200;
constexpr int kFreeze_ms = 1700, kThaw_ms = 2200;

struct BurstLoss {
  std::mt19937 random;
  bool bad = false;
  bool lost() {
    const double u = static_cast<double>(random() >> 5) * 0x1p-27;
    bad = bad ? u >= 0.1 : u < 0.1 * 0.3 / 0.7;
    return bad;
  }
};

}  // namespace

MonotoneCubic path_of(Act act) {
  const double top = kTool_m + 0.01;
  std::vector<double> times{0, kWait_s};
  std::vector<Vector3d> places{place(top), place(top)};
  const auto go = [&](double t, double z) { times.push_back(kWait_s + t), places.push_back(place(z)); };
  if (act == Act::kPress) {
    go(0.3, kTool_m - kPress_m), go(1e-3 * kHold_ms - kWait_s, kTool_m - kPress_m),
        go(1e-3 * kHold_ms - kWait_s + 0.3, top);
  } else if (act == Act::kTap) {
    for (int k = 0; k < 5; ++k)
      go(0.5 * k + 0.15, kTool_m - kTap_m), go(0.5 * k + 0.2, kTool_m - kTap_m), go(0.5 * k + 0.35, top),
          go(0.5 * k + 0.5, top);
  } else {
    go(1.2, kTool_m - kPush_m), go(1.6, kTool_m - kPush_m), go(2, top);
  }
  return {times, places, MonotoneCubic::Ends::kRest};
}

Sway sway(const std::vector<double>& y) {
  constexpr double kSwing_N = 0.03;
  const double n = static_cast<double>(y.size());
  double mean = 0, slope = 0, squares = 0;
  for (const double v : y) mean += v / n;
  const auto x = [&](std::size_t i) { return (static_cast<double>(i) + 0.5) / n - 0.5; };
  for (std::size_t i = 0; i < y.size(); ++i) slope += 12 / n * x(i) * y[i];
  Sway s;
  int side = 0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double off = y[i] - mean - slope * x(i);
    squares += off * off / n;
    const int now = off > kSwing_N ? 1 : off < -kSwing_N ? -1 : side;
    s.swings += side != 0 && now != side;
    side = now;
  }
  s.rms_N = std::sqrt(squares);
  return s;
}

namespace {

double ideal_N(const EpisodeDef& def) {
  if (def.act == Act::kPush) return kTableFriction * kGravity_m_s2 * def.mass_kg;
  double compliance = 1 / def.hand.stiffness_N_m + 1 / def.stiffness_N_m;
  if (def.mass_kg > 0) compliance += 1 / kBodySpring_N_m;
  return (def.act == Act::kPress ? kPress_m : kTap_m) / compliance;
}

}  // namespace

EpisodeResult run_episode(const EpisodeDef& def, bool timed) {
  VirtualHand hand(path_of(def.act), false, def.hand);
  hand.begin(host_ms(0));
  Bench bench(def.settings);
  EpisodeWorld world{def.mass_kg, def.stiffness_N_m, def.act == Act::kPush};
  BurstLoss bursts{std::mt19937(def.seed)};
  std::deque<touch_model_t> in_transit;
  touch_model_t now_used;
  EpisodeResult r;
  r.ideal_N = ideal_N(def);
  const int per_ms = static_cast<int>(def.settings.rate_Hz / 1000);
  double felt = 0, applied = 0, hand_J = 0, baseline_J = 0, last_force = 0, last_z = 0, sum = 0, depth = 0;
  std::vector<double> held_N, before_N, earlier_N;
  double last_sent_ms = -1e9, last_felt_ms = 0;
  int judged = 0;
  bool begun = false;
  const bool press = def.act == Act::kPress, push = def.act == Act::kPush;
  for (int i = 0; i < kEnd_ms * per_ms; ++i) {
    const double ms = static_cast<double>(i) / per_ms;
    const touch_model_t* fresh = nullptr;
    if (i % per_ms == 0) {
      // The reported force of the hand reaches the body a step later, as the mean force of that step.
      world.step(-(felt - applied) / kStep_s);
      applied = felt;
      const bool lost = def.network.bursts && bursts.lost();
      const bool frozen = def.network.freezes && ms >= kFreeze_ms && ms < kThaw_ms;
      if (!lost && !frozen && ms - last_sent_ms >= 1000 / def.network.rate_Hz - 1e-9)
        in_transit.push_back(world.model_at(static_cast<int>(ms))), last_sent_ms = ms;
      while (!in_transit.empty() &&
             in_transit.front().header.sim_time_ns <= (static_cast<int>(ms) - def.network.delay_ms) * kMs) {
        now_used = in_transit.front();
        in_transit.pop_front();
        fresh = &now_used;
      }
    }
    const DeviceState state = hand.read(host_ms(ms));
    if (begun) hand_J -= last_force * (state.position.z() - last_z);
    begun = true;
    last_z = state.position.z();
    const double out_J = world.energy_J - baseline_J - hand_J;
    r.generated_mJ = std::max(r.generated_mJ, 1e3 * out_J);
    if (ms - last_felt_ms > kApart_ms) hand_J = 0, baseline_J = world.energy_J;
    TickInput in;
    in.touch_delay = sync::Nanoseconds(def.network.delay_ms * kMs);
    bench.arrival = host_ms(ms);  // an intended degradation: the messages themselves keep arriving
    const auto begin = std::chrono::steady_clock::now();
    const TickOutput& out = bench.tick(ms, state.position, fresh, {}, in);
    if (timed)
      r.tick_us.push_back(
          std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
    hand.write(out.force_N);
    r.largest_step_N = std::max(r.largest_step_N, std::abs(out.force_N.z() - last_force));
    last_force = out.force_N.z();
    if (last_force != 0 || state.position.z() < world.z + kTool_m) last_felt_ms = ms;
    r.peak_N = std::max(r.peak_N, last_force);
    for (const tool_constraint_t& c : out.state.constraints) felt = c.impulse_N_s.z;
    r.observed_mJ = std::max(r.observed_mJ, 1e3 * out.state.generated_J);
    r.least_coupling = std::min<double>(r.least_coupling, out.state.coupling);
    if (press && ms >= kHold_ms - 3 * kJudged_ms && ms < kHold_ms - 2 * kJudged_ms)
      earlier_N.push_back(last_force);
    if (press && ms >= kHold_ms - 2 * kJudged_ms && ms < kHold_ms - kJudged_ms) before_N.push_back(last_force);
    if ((press && ms >= kHold_ms - kJudged_ms && ms < kHold_ms) || (push && ms >= 1200 && ms < 2100)) {
      ++judged;
      sum += last_force;
      held_N.push_back(last_force);
      depth += world.z + kTool_m - state.position.z();
    }
  }
  if (judged > 0) {
    r.force_N = sum / judged;
    r.sway_N = sway(held_N).rms_N;
    r.swings = sway(held_N).swings;
    r.sway_before_N = sway(before_N).rms_N;
    r.sway_least_N = std::min({r.sway_N, r.sway_before_N, sway(earlier_N).rms_N});
    r.stiffness_N_m = depth > 0 ? sum / depth : 0;
  }
  r.pushed_m = -world.z;
  return r;
}

std::span<const HandKind> hand_kinds() {
  // finger: 92 N/m and 41 N/m more for each newton of pressing force, between 2 and 20 N (Hajian and Howe 1997, as
  // fitted by Friedman and Flash 2007): that of 7.5 N; grams and a few N s/m, orders of magnitude. hand: holds a
  // stylus like a pen, 0.20 to 0.27 kg, 4.6 to 18 N s/m and 79 to 272 N/m, by direction (Fu and Cavusoglu 2012,
  // table II: M, b2, k2). arm: a kilogram and tens of N s/m (Tsuji et al. 1995), hundreds of N/m (Mussa-Ivaldi,
  // Hogan and Bizzi 1985): orders of magnitude. Numbers are as quoted by others; the original papers were not
  // available.
  static constexpr HandKind kKinds[] = {
      {"default", {0.1, 10, 300}}, {"finger", {0.006, 4, 400}}, {"hand", {0.2, 6, 150}}, {"arm", {1.0, 20, 400}}};
  return kKinds;
}

}  // namespace tactus::haptic::test
