// Does touch give a hand more energy than the bodies gave it? A hand with the impedance of the virtual hand
// presses on a fixed wall or on a body that moves, holds and lets go, while the touch model is late, thin, lossy
// or frozen.
//
//   bin/passivity_table [--json FILE]
//
// generated: the most that device port and body port have given together, over what they had taken in, at any
// moment of the episode (time-domain passivity: Hannaford and Ryu 2002). The world of a wall takes
// nothing. cycle: the force sways by more than 0.05 N rms at the end of the hold, be it by itself or because the
// coupling's stiffness still changes. Beside it what is left of touch: the mean force of the hold against that of
// springs in a row, the rendered stiffness against the surface's.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <deque>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "haptic_node/devices/virtual_hand.h"
#include "tests/haptic_node/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

constexpr double kDt = 1e-3, kTool_m = 0.005, kPress_m = 0.01;
// The body hangs on a spring so that it can be pressed on; the damper takes its swing within seconds.
constexpr double kBodySpring_N_m = 500, kBodyDamper_Ns_m = 0.5;
constexpr int kHold_ms = 2300, kEnd_ms = 3500, kJudged_ms = 500;

struct Network {
  const char* name;
  int delay_ms = 0;
  double rate_Hz = 1000;
  bool bursts = false, freezes = false;
};
constexpr Network kNetworks[] = {{"as it is"},
                                 {"10 ms late", 10},
                                 {"25 ms late", 25},
                                 {"50 ms late", 50},
                                 {"30 Hz", 0, 30},
                                 {"30 % lost in bursts", 0, 1000, true},
                                 {"frozen 0.5 s", 0, 1000, false, true}};

// Gilbert's chain: lost 30 % of the time, 10 messages in a row on average.
struct Bursts {
  std::mt19937 random{7};
  bool bad = false;
  bool lost() {
    const double u = static_cast<double>(random() >> 5) * 0x1p-27;
    bad = bad ? u >= 0.1 : u < 0.1 * 0.3 / 0.7;
    return bad;
  }
};

struct Result {
  double generated_mJ = 0, sway_N = 0, force_N = 0, ideal_N = 0, stiffness_N_m = 0;
};

// mass_kg 0: a wall.
Result press(double mass_kg, double stiffness_N_m, const Network& network) {
  const Settings settings;
  const double top = kTool_m + 0.01, bottom = kTool_m - kPress_m;
  const auto place = [](double z) { return Vector3d(0, 0, z); };
  VirtualHand hand(
      MonotoneCubic({0, 0.3, 1e-3 * kHold_ms, 1e-3 * kHold_ms + 0.3},
                    {place(top), place(bottom), place(bottom), place(top)}, MonotoneCubic::Ends::kRest),
      false, {settings.hand_mass_kg, settings.hand_damping_Ns_m, settings.hand_stiffness_N_m});
  hand.begin(host_ms(0));
  Bench bench(settings);
  Bursts bursts;
  std::deque<touch_model_t> on_the_way;
  touch_model_t now_used;
  Result r;
  double z = 0, v = 0, impulse = 0, told = 0, taken_J = 0, last_force = 0, last_z = top, sum = 0, squares = 0,
         depth = 0;
  int judged = 0;
  double last_sent_ms = -1e9;
  for (int ms = 0; ms < kEnd_ms; ++ms) {
    if (mass_kg > 0) {
      // What the hand was told of reaches the body a step later, as the mean force of that step.
      const double force = -(impulse - told) / kDt;
      v += kDt * (force - kBodySpring_N_m * z - kBodyDamper_Ns_m * v) / mass_kg;
      z += kDt * v;
      taken_J -= force * v * kDt;  // this step moves the body by v dt
    }
    told = impulse;
    auto p = plane(7, place(z), Vector3d::UnitZ());
    p.stiffness_N_m = static_cast<float>(stiffness_N_m);
    if (mass_kg > 0) {
      p.effective_mass_kg = static_cast<float>(mass_kg);
      p.velocity_m_s = to_vec3f(place(v));
    }
    const bool lost = network.bursts && bursts.lost();
    const bool frozen = network.freezes && ms >= 1000 && ms < 1500;
    if (!lost && !frozen && ms - last_sent_ms >= 1000 / network.rate_Hz - 1e-9)
      on_the_way.push_back(model(ms, {p})), last_sent_ms = ms;
    const touch_model_t* fresh = nullptr;
    while (!on_the_way.empty() && on_the_way.front().header.sim_time_ns <= (ms - network.delay_ms) * kMs) {
      now_used = on_the_way.front();
      on_the_way.pop_front();
      fresh = &now_used;
    }
    const DeviceState state = hand.read(host_ms(ms));
    taken_J -= last_force * (state.position.z() - last_z);
    last_z = state.position.z();
    r.generated_mJ = std::max(r.generated_mJ, -1e3 * taken_J);
    TickInput in;
    in.touch_delay = sync::Nanoseconds(network.delay_ms * kMs);
    bench.arrival = host_ms(ms);  // degraded on purpose: the messages themselves keep coming
    const TickOutput& out = bench.tick(ms, state.position, fresh, {}, in);
    hand.write(out.force_N);
    last_force = out.force_N.z();
    for (const tool_constraint_t& c : out.state.constraints) impulse = c.impulse_N_s.z;
    if (ms >= kHold_ms - kJudged_ms && ms < kHold_ms) {
      ++judged;
      sum += last_force;
      squares += last_force * last_force;
      depth += z + kTool_m - state.position.z();
    }
  }
  r.force_N = sum / judged;
  r.sway_N = std::sqrt(std::max(0.0, squares / judged - r.force_N * r.force_N));
  r.stiffness_N_m = depth > 0 ? sum / depth : 0;
  double compliance = 1 / settings.hand_stiffness_N_m + 1 / stiffness_N_m;
  if (mass_kg > 0) compliance += 1 / kBodySpring_N_m;
  r.ideal_N = kPress_m / compliance;
  return r;
}

}  // namespace

int main(int argc, char** argv) {
  std::string json;
  CLI::App app{"Does touch give a hand more energy than the bodies gave it?"};
  app.add_option("--json", json, "also write the figures there");
  CLI11_PARSE(app, argc, argv);
  std::printf("%-16s %-20s %12s %8s %6s %8s %9s %10s\n", "surface", "touch model", "generated mJ", "sway N",
              "cycle", "force N", "of ideal", "K N/m");
  nlohmann::json out = nlohmann::json::array();
  const auto row = [&](double mass_kg, double stiffness_N_m) {
    char name[32];
    if (mass_kg > 0)
      std::snprintf(name, sizeof name, "body %g kg", mass_kg);
    else
      std::snprintf(name, sizeof name, "wall %g N/m", stiffness_N_m);
    for (const Network& n : kNetworks) {
      const Result r = press(mass_kg, stiffness_N_m, n);
      const bool cycle = r.sway_N > 0.05;
      std::printf("%-16s %-20s %12.3f %8.4f %6s %8.3f %9.3f %10.1f\n", name, n.name, r.generated_mJ, r.sway_N,
                  cycle ? "yes" : "no", r.force_N, r.force_N / r.ideal_N, r.stiffness_N_m);
      out.push_back({{"surface", name},
                     {"touch_model", n.name},
                     {"generated_mJ", r.generated_mJ},
                     {"sway_N", r.sway_N},
                     {"cycle", cycle},
                     {"force_N", r.force_N},
                     {"ideal_N", r.ideal_N},
                     {"stiffness_N_m", r.stiffness_N_m}});
    }
  };
  for (const double k : {200.0, 1000.0, 5000.0}) row(0, k);
  for (const double m : {0.05, 0.2, 1.0}) row(m, 1000);
  if (!json.empty()) std::ofstream(json) << out.dump(2) << "\n";
  return 0;
}
