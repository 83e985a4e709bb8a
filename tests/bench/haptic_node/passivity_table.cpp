// Energy that touch generates beyond the energy that it received from hand and body. Hands of three sizes press on
// walls and bodies, tap on them and push bodies along, while the touch model is late, thin, lossy or frozen; and
// the remaining quality of touch.
//
//    bin/passivity_table [--check] [--all] [--seeds N | --seed N] [--only network|devices] [--full] [--json FILE]
//
// The first table is about the touch model, the others about the device (passivity_devices.h): its rate, its delay each
// way and its own damping, as known to the node; and the tick rate of the node. Their columns:
//   seen        maximum of the energy that the observer reports; error: its largest difference from the generated energy
//   K, theory   stiffness of the hold, and min(surface, (b - B) / (T / 2 + delay)) with the delay that really passed and
//               B as in coupling.h; for a body: the stiffness by the rules of coupling.h; used: their ratio
// --full: the whole grid of devices (some minutes). The limits there: 1 mJ, error 0.5 mJ, no cycle, used at least 0.7.
//
// A row is one surface with one touch model. Each figure is the worst of all hands and, if messages are lost at
// random, of all seeds; energies are the worst of pressing, tapping and pushing along
// (tests/haptic_node/support/episode.h):
//   generated   maximum net energy that leaves device port and body port together in an episode
//   told_mJ     maximum of the same energy, as the observer of the renderer reports it
//   without     the value of generated with the controller switched off
//   cycle       the force oscillates at the end of the hold by more than 0.05 N rms and does not decay
//   of ideal    mean force of the hold relative to springs in series: hand, surface and support of the body
//   of design   the same, relative to the stiffness that the coupling rules allow for a mass at that delay
//   K           force over depth
//   factor      the minimum that the controller chose
// --all prints every episode. --check: exit 1 where generated > 1 mJ, at a cycle, or where touch is too weak: a
// wall whose force is off by more than 25 %; a body with less than half of the design force (a fifth after losses
// and a gap, after which touch is softer than the mean age implies), or a body that is pushed by less than half of
// the distance.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

#include "haptic_node/rendering/coupling.h"
#include "sync/node/node_options.h"
#include "tests/bench/haptic_node/passivity_devices.h"
#include "tests/haptic_node/support/episode.h"

using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

constexpr Network kNetworks[] = {{"as it is"},
                                 {"1 ms late", 1},
                                 {"5 ms late", 5},
                                 {"10 ms late", 10},
                                 {"25 ms late", 25},
                                 {"50 ms late", 50},
                                 {"30 Hz", 0, 30},
                                 {"30 % lost in bursts", 0, 1000, true},
                                 {"frozen 0.5 s", 0, 1000, false, true},
                                 {"25 ms late, 30 Hz", 25, 30},
                                 {"25 ms late, bursts", 25, 1000, true},
                                 {"10 ms late, frozen", 10, 1000, false, true}};
constexpr const char* kActs[] = {"press", "tap", "push"};
constexpr double kMaxGenerated_mJ = 1;

struct SurfaceKind {
  double mass_kg, stiffness_N_m;  // 0: a wall
  std::string name() const {
    char text[32];
    if (mass_kg > 0)
      std::snprintf(text, sizeof text, "body %g kg", mass_kg);
    else
      std::snprintf(text, sizeof text, "wall %g N/m", stiffness_N_m);
    return text;
  }
};
constexpr SurfaceKind kSurfaces[] = {{0, 200},    {0, 1000},   {0, 5000},   {0.05, 1000},
                                     {0.1, 1000}, {0.2, 1000}, {0.5, 1000}, {1, 1000}};

// The stiffness that the coupling rules allow at the mean age of the touch model.
double design_N_m(const EpisodeDef& def) {
  const Settings& s = def.settings;
  const double age_s = 1e-3 * def.network.delay_ms + (def.network.rate_Hz < 1000 ? 0.5 / def.network.rate_Hz : 0);
  return coupling_gains(
             def.stiffness_N_m, 0, def.mass_kg > 0 ? def.mass_kg : 1e10, age_s + 0.002, 1e-3,
             {s.stiffness_limit_N_m, s.mass_factor, s.damping_ratio, s.device_mass_kg, s.device_damping_Ns_m})
      .stiffness_N_m;
}
// The force of the hold with that stiffness, and the distance that a body is pushed along.
double design_N(const EpisodeDef& def, double ideal_N) {
  return kPress_m / (kPress_m / ideal_N - 1 / def.stiffness_N_m + 1 / design_N_m(def));
}
double design_m(const EpisodeDef& def, double friction_N) {
  return std::max(0.0, kPush_m - friction_N / design_N_m(def) - friction_N / def.hand.stiffness_N_m);
}

// An episode with the controller, and the energy generated without it.
struct Pair {
  EpisodeResult with;
  double without_mJ = 0;
};
Pair with_and_without(EpisodeDef def) {
  Pair pair{run_episode(def)};
  def.settings.generated_limit_J = 1e9;
  pair.without_mJ = run_episode(def).generated_mJ;
  return pair;
}

// Without random losses, one seed is enough.
std::vector<unsigned> seeds_of(const Network& network, unsigned seeds) {
  std::vector<unsigned> all(network.bursts ? seeds : 1);
  std::iota(all.begin(), all.end(), 1u);
  return all;
}

struct Row {
  double generated_mJ = 0, observed_mJ = 0, without_mJ = 0, of_ideal = 1e9, max_of_ideal = 0, of_design = 1e9,
         K_N_m = 1e9, factor = 1, pushed = 1e9;
  bool cycle = false;
  bool good = true;

  void add(const EpisodeDef& def, const Pair& pair) {
    const EpisodeResult& r = pair.with;
    generated_mJ = std::max(generated_mJ, r.generated_mJ);
    observed_mJ = std::max(observed_mJ, r.observed_mJ);
    without_mJ = std::max(without_mJ, pair.without_mJ);
    factor = std::min(factor, r.least_coupling);
    if (def.act == Act::kPress) {
      cycle = cycle || r.cycles();
      of_ideal = std::min(of_ideal, r.force_N / r.ideal_N);
      max_of_ideal = std::max(max_of_ideal, r.force_N / r.ideal_N);
      of_design = std::min(of_design, r.force_N / design_N(def, r.ideal_N));
      K_N_m = std::min(K_N_m, r.stiffness_N_m);
    }
    if (def.act == Act::kPush) pushed = std::min(pushed, r.pushed_m - 0.5 * design_m(def, r.ideal_N));
  }
};

void print(const char* hand, const EpisodeDef& def, const EpisodeResult& r) {
  std::printf(
      "  %-10s %-6s seed %2u generated %8.3f observed %8.3f factor %5.3f sway %7.4f force %7.3f of ideal %6.3f peak "
      "%6.2f step %5.3f pushed %6.3f%s\n",
      hand, kActs[static_cast<int>(def.act)], def.seed, r.generated_mJ, r.observed_mJ, r.least_coupling, r.sway_N,
      r.force_N, r.force_N / r.ideal_N, r.peak_N, r.largest_step_N, r.pushed_m,
      def.act == Act::kPress && r.cycles() ? "  cycles" : "");
}

nlohmann::json as_json(const SurfaceKind& surface, const char* hand, const EpisodeDef& def, const Pair& pair) {
  const EpisodeResult& r = pair.with;
  return {{"surface", surface.name()},
          {"touch_model", def.network.name},
          {"hand", hand},
          {"act", kActs[static_cast<int>(def.act)]},
          {"seed", def.seed},
          {"generated_mJ", r.generated_mJ},
          {"told_mJ", r.observed_mJ},
          {"without_mJ", pair.without_mJ},
          {"factor", r.least_coupling},
          {"sway_N", r.sway_N},
          {"force_N", r.force_N},
          {"ideal_N", r.ideal_N},
          {"peak_N", r.peak_N},
          {"largest_step_N", r.largest_step_N},
          {"pushed_m", r.pushed_m}};
}

bool good(const SurfaceKind& surface, const Network& network, const Row& r) {
  if (r.generated_mJ > kMaxGenerated_mJ || r.cycle) return false;
  if (surface.mass_kg <= 0) return r.of_ideal > 0.75 && r.max_of_ideal < 1.25;
  return r.of_design >= (network.bursts || network.freezes ? 0.2 : 0.5) && r.pushed >= 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::string json, only;
  bool check = false, all = false, full = false;
  unsigned seed = 0, seeds = 8;
  tactus::sync::Arguments app{"Energy that touch adds to a hand and a body (passivity)."};
  app.add_option("--json", json, "also writes the figures to this file");
  app.add_flag("--check", check, "exit 1 unless all rows stay within the limits");
  app.add_option("--seeds", seeds, "draws losses with the seeds 1 to N").range(1, 10000);
  app.add_option("--seed", seed, "draws losses with this seed only").excludes("--seeds");
  app.add_flag("--all", all, "print every episode");
  app.add_option("--only", only, "print one part: network or devices").one_of({"network", "devices"});
  app.add_flag("--full", full, "the whole grid of devices");
  tactus::sync::parse_or_exit(app, "passivity_table", argc, argv);
  nlohmann::json by_device = nlohmann::json::array(), by_rate = nlohmann::json::array();
  const bool devices_good =
      only == "network" || (static_cast<int>(tactus::bench::device_table(by_device, full, all)) &
                            static_cast<int>(tactus::bench::rate_table(by_rate))) != 0;
  if (only == "devices") {
    if (!json.empty())
      std::ofstream(json) << nlohmann::json{{"devices", by_device}, {"rates", by_rate}}.dump(1) << "\n";
    return check && !devices_good ? 1 : 0;
  }
  std::printf("%-14s %-20s %9s %9s %9s %6s %9s %10s %8s %7s\n", "surface", "touch model", "gen. mJ", "told mJ",
              "without", "cycle", "of ideal", "of design", "K N/m", "factor");
  nlohmann::json rows = nlohmann::json::array(), episodes = nlohmann::json::array();
  bool everything_good = true;
  for (const SurfaceKind& surface : kSurfaces)
    for (const Network& network : kNetworks) {
      Row row;
      for (const HandKind& hand : hand_kinds())
        for (const Act act : {Act::kPress, Act::kTap, Act::kPush}) {
          if (act == Act::kPush && surface.mass_kg <= 0) continue;
          for (const unsigned drawn : seed ? std::vector{seed} : seeds_of(network, seeds)) {
            EpisodeDef def;
            def.act = act, def.mass_kg = surface.mass_kg, def.stiffness_N_m = surface.stiffness_N_m;
            def.network = network, def.hand = hand.impedance, def.seed = drawn;
            const Pair pair = with_and_without(def);
            row.add(def, pair);
            if (all) print(hand.name, def, pair.with);
            episodes.push_back(as_json(surface, hand.name, def, pair));
          }
        }
      row.good = good(surface, network, row);
      everything_good = everything_good && row.good;
      std::printf("%-14s %-20s %9.3f %9.3f %9.2f %6s %9.3f %10.3f %8.1f %7.3f%s\n", surface.name().c_str(),
                  network.name, row.generated_mJ, row.observed_mJ, row.without_mJ, row.cycle ? "yes" : "no",
                  row.of_ideal, row.of_design, row.K_N_m, row.factor, row.good ? "" : "  <- beyond its limits");
      rows.push_back({{"surface", surface.name()},
                      {"touch_model", network.name},
                      {"delay_ms", network.delay_ms},
                      {"plain_delay", network.rate_Hz == 1000 && !network.bursts && !network.freezes},
                      {"generated_mJ", row.generated_mJ},
                      {"told_mJ", row.observed_mJ},
                      {"without_mJ", row.without_mJ},
                      {"cycle", row.cycle},
                      {"of_ideal", row.of_ideal},
                      {"of_design", row.of_design},
                      {"stiffness_N_m", row.K_N_m},
                      {"factor", row.factor},
                      {"good", row.good}});
    }
  // Cost of the disturbances for the servo loop.
  std::printf("\n%-20s %10s %10s\n", "touch model", "median us", "p99 us");
  nlohmann::json ticks = nlohmann::json::array();
  for (const Network& network : kNetworks) {
    EpisodeDef def;
    def.mass_kg = 0.2, def.network = network;
    std::vector<double> us = run_episode(def, true).tick_us;
    std::sort(us.begin(), us.end());
    const double median = us[us.size() / 2], p99 = us[us.size() * 99 / 100];
    std::printf("%-20s %10.2f %10.2f\n", network.name, median, p99);
    ticks.push_back({{"touch_model", network.name}, {"median_us", median}, {"p99_us", p99}});
  }
  if (!json.empty())
    std::ofstream(json) << nlohmann::json{{"rows", rows},       {"episodes", episodes}, {"ticks", ticks},
                                          {"devices", by_device}, {"rates", by_rate}}
                                .dump(1)
                        << "\n";
  return check && !(everything_good && devices_good) ? 1 : 0;
}
