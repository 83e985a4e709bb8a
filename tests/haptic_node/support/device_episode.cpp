#include "tests/haptic_node/support/device_episode.h"

#include <cmath>
#include <deque>
#include <memory>
#include <optional>
#include <random>
#include <tactus/tool_constraint_t.hpp>

#include "haptic_node/devices/external.h"
#include "haptic_node/rendering/session.h"
#include "tests/haptic_node/support/episode_world.h"

namespace tactus::haptic::test {
namespace {

constexpr double kFine_s = 125e-6;
constexpr int kFinePerStep = 8, kEnd_s = 5;
constexpr double kHold_s = 3.8, kJudged_s = 0.5, kApart_s = 0.2;

// The hand with its device, along z. Exact energy for a force that is constant in a step: force times motion.
struct HeldDevice {
  const DeviceEpisodeDef& def;
  MonotoneCubic path = path_of(def.act);
  double z = kTool_m + 0.01, v = 0, force_N = 0;

  // Returns the work of the force, J.
  double step(double t) {
    const HandImpedance& h = def.hand;
    const auto target = path.at(t);
    const double before = z;
    for (int half = 0; half < 2; ++half) {
      constexpr double dt = kFine_s / 2;
      const double push = force_N + h.stiffness_N_m * (target.position.z() - z) + h.damping_N_s_m * target.velocity.z();
      v = (v + dt / h.mass_kg * push) / (1 + dt / h.mass_kg * (h.damping_N_s_m + def.damping_N_s_m));
      z += dt * v;
    }
    return force_N * (z - before);
  }
};

struct InTick : Device {
  explicit InTick(HeldDevice& to) : held(to) {}
  DeviceState read(sync::HostTime) override {
    DeviceState s;
    s.position = place(held.z);
    s.velocity = place(held.v);
    return s;
  }
  using Device::write;
  void write(const Wrench& w) override { held.force_N = w.force_N.z(); }
  HeldDevice& held;
};

// The driver, with the messages under way between it and the node.
struct Driver {
  struct Command {
    double sent_s, arrival_s, stamp_s, force_N;
  };
  const DeviceEpisodeDef& def;
  HeldDevice& held;
  double next_s = 0, stamp_s = -1;
  std::int64_t seq = 0;
  std::deque<std::pair<double, device_state_t>> states{};  // with their arrival
  std::deque<Command> commands{};
  Command received{-1, -1, -1, 0};
  std::mt19937 random{def.seed};
  double last_state_s = 0, last_command_s = 0;  // newest arrivals
  double delay_sum_s = 0;
  int delays = 0;

  void step(double t) {
    while (!commands.empty() && commands.front().sent_s < t - 1e-9 && commands.front().arrival_s <= t + 1e-9)
      received = commands.front(), commands.pop_front();
    const bool due = t >= next_s - 1e-9;
    if (due || def.at_once) apply(t);
    if (!due) return;
    const double rate_Hz = def.slows_at_s >= 0 && t >= def.slows_at_s ? def.slow_Hz : def.device_Hz;
    next_s = std::max(next_s + 1 / rate_Hz, t);
    device_state_t m{};
    m.header.sim_time_ns = -1;
    m.header.publish_time_ns = kStart + std::llround(t * 1e9);
    m.header.run_id = 1;
    m.header.incarnation = 5;
    m.header.seq = seq++;
    m.device = "arm";
    m.pose.position_m.z = held.z;
    m.pose.orientation.w = 1;
    m.velocity_m_s.z = static_cast<float>(held.v);
    if (const auto arrival_s = arrival(t, last_state_s)) states.emplace_back(*arrival_s, m);
  }
  void command(double t, double force_N) {
    if (const auto arrival_s = arrival(t, last_command_s)) commands.push_back({t, *arrival_s, stamp_s, force_N});
  }
  double drawn() { return static_cast<double>(random() >> 5) * 0x1p-27; }
  // Of a message sent now; nothing: it is lost.
  std::optional<double> arrival(double t, double& last_s) {
    if (def.loss > 0 && drawn() < def.loss) return std::nullopt;
    last_s = std::max(last_s, t + 1e-3 * (def.delay_ms + (def.jitter_ms > 0 ? def.jitter_ms * drawn() : 0)));
    return last_s;
  }
  void apply(double t) {
    if (received.stamp_s < 0) return;
    if (received.force_N != held.force_N) delay_sum_s += t - received.stamp_s, ++delays;
    held.force_N = received.force_N;
  }
  // The states that have arrived go to the node.
  void deliver(double t, Session& session) {
    for (; !states.empty() && states.front().first <= t + 1e-9; states.pop_front()) {
      session.push(states.front().second, host_ms(1e3 * t));
      stamp_s = 1e-9 * static_cast<double>(states.front().second.header.publish_time_ns - kStart);
    }
  }
};

double theory_N_m(const DeviceEpisodeDef& def, double delay_s) {
  const Settings& s = def.settings;
  const double tick_s = 1 / s.rate_Hz, hold_s = def.device_Hz > 0 ? std::max(tick_s, 1 / def.device_Hz) : tick_s;
  const double b = s.device_damping_Ns_m, lag_s = hold_s / 2 + delay_s;
  const CouplingLimits limits{s.stiffness_limit_N_m, s.mass_factor, s.damping_ratio,
                              s.device_mass_kg,      b,             kHeldDamping_N_s_m};
  if (def.mass_kg > 0)
    // A step, a tick, the hold of the push and the lag of the device.
    return coupling_gains(def.stiffness_N_m, 0, def.mass_kg,
                          kStep_s + tick_s + std::max(0.0, tick_s - kStep_s) + lag_s - tick_s / 2, hold_s, limits, delay_s)
        .stiffness_N_m;
  // The largest damping that the rules allow: any K beyond it is not passive with any B.
  const double damping = b >= 0.1 ? b / 2 : 0;
  return std::min({def.stiffness_N_m, s.stiffness_limit_N_m, (b - damping) / lag_s});
}

class EpisodeMeter {
 public:
  EpisodeMeter(const DeviceEpisodeDef& def, DeviceEpisodeResult& result) : def_(def), r_(result) {}

  void add(double t, double work_J, const HeldDevice& held, const EpisodeWorld& world) {
    r_.energy_J += work_J;
    hand_J_ += work_J;
    r_.generated_mJ = std::max(r_.generated_mJ, 1e3 * (hand_J_ + world.energy_J - baseline_J_));
    r_.peak_N = std::max(r_.peak_N, held.force_N);
    const double depth = world.z + kTool_m - held.z;
    if (held.force_N != 0 || depth > 0) felt_s_ = t;
    if (t - felt_s_ > kApart_s) hand_J_ = 0, baseline_J_ = world.energy_J;
    if (def_.act != Act::kPress || t < kHold_s - 3 * kJudged_s || t >= kHold_s) return;
    auto& window = windows_[std::min(2, static_cast<int>((t - kHold_s + 3 * kJudged_s) / kJudged_s))];
    window.push_back(held.force_N);
    if (t >= kHold_s - kJudged_s) sum_N_ += held.force_N, depth_m_ += depth;
  }
  void finish() {
    if (windows_[2].empty()) return;
    r_.force_N = sum_N_ / static_cast<double>(windows_[2].size());
    const Sway last = sway(windows_[2]);
    r_.sway_N = last.rms_N, r_.swings = last.swings, r_.sway_before_N = sway(windows_[1]).rms_N;
    r_.sway_least_N = std::min({r_.sway_N, r_.sway_before_N, sway(windows_[0]).rms_N});
    r_.stiffness_N_m = depth_m_ > 0 ? sum_N_ / depth_m_ : 0;
  }

 private:
  const DeviceEpisodeDef& def_;
  DeviceEpisodeResult& r_;
  double hand_J_ = 0, baseline_J_ = 0, felt_s_ = 0, sum_N_ = 0, depth_m_ = 0;
  std::vector<double> windows_[3];
};

}  // namespace

DeviceEpisodeResult run_device_episode(const DeviceEpisodeDef& def) {
  HeldDevice held{def};
  Driver driver{def, held};
  EpisodeWorld world{def.mass_kg, def.stiffness_N_m, def.act == Act::kPush};
  DeviceEpisodeResult r;
  EpisodeMeter meter(def, r);
  const scene_t in_scene = scene();
  NodeConfig config;
  config.tool = 0, config.settings = def.settings;
  Safety safety(safety_limits(def.settings));
  const bool external = def.device_Hz > 0;
  std::unique_ptr<Device> device;
  if (external)
    device = std::make_unique<External>("arm", Vector3d::Zero(), ExternalDef{.at_once = def.at_once && def.known_output});
  else
    device = std::make_unique<InTick>(held);
  const auto session =
      std::make_unique<Session>(in_scene, config, std::move(device), sync::OwnClock{1, 0, nullptr}, safety);
  double next_tick_s = 0, felt = 0, applied = 0, mean_N = 0;
  bool reported = false;
  for (int i = 0; i < kEnd_s * 1000 * kFinePerStep; ++i) {
    const double t = i * kFine_s;
    if (i % kFinePerStep == 0) {
      // The simulation applies the newest reported impulse as a mean force, and holds it until the next report.
      if (reported) mean_N = (felt - applied) / std::max(kStep_s, 1 / def.settings.rate_Hz), applied = felt;
      reported = false;
      world.step(-mean_N);
      touch_model_t m = world.model_at(i / kFinePerStep);
      m.header.publish_time_ns = m.clock.host_ns;
      session->push(std::move(m), host_ms(1e3 * t));
    }
    if (external) {
      driver.step(t);
      driver.deliver(t, *session);
    }
    if (t >= next_tick_s - 1e-9) {
      next_tick_s = std::max(next_tick_s + 1 / def.settings.rate_Hz, t);
      const TickOutput& out = session->step(host_ms(1e3 * t));
      if (external) driver.command(t, session->force_message()->force_N.z);
      for (const tool_constraint_t& c : out.state.constraints) felt = c.impulse_N_s.z;
      reported = true;
      r.observed_mJ = std::max(r.observed_mJ, 1e3 * out.state.generated_J);
      r.least_coupling = std::min<double>(r.least_coupling, out.state.coupling);
      r.reported_energy_J = out.state.energy_J;
    }
    if (i % (5 * kFinePerStep) == 0) {
      const auto limit = session->device_limit();
      r.limits.push_back({t, limit.stiffness_N_m, limit.softened});
    }
    meter.add(t, held.step(t), held, world);
  }
  meter.finish();
  r.delay_s = driver.delays > 0 ? driver.delay_sum_s / driver.delays : 0;
  r.theory_N_m = theory_N_m(def, r.delay_s);
  return r;
}

std::span<const HandKind> device_hands() {
  // grip: fingers that hold a light handle; hand: as in episode.cpp; stiff: the hand of a person who tenses it, 14 N s/m
  // and 533 N/m (Fu and Cavusoglu 2012, table III, upper end, as others quote it); arm: orders of magnitude only.
  static constexpr HandKind kKinds[] = {{"grip", {0.05, 4, 300}},
                                        {"hand", {0.2, 6, 150}},
                                        {"stiff", {0.5, 14, 533}},
                                        {"arm", {2.0, 20, 400}}};
  return kKinds;
}

}  // namespace tactus::haptic::test
