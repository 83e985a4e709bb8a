// Rows of devices: see passivity_devices.h; the episodes are those of tests/haptic_node/support/device_episode.h.
#include "tests/bench/haptic_node/passivity_devices.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/haptic_node/support/device_episode.h"

namespace tactus::bench {
namespace {

using namespace haptic::test;

constexpr double kMaxGenerated_mJ = 1, kMaxError_mJ = 0.5, kUsed = 0.7;
constexpr const char* kActs[] = {"press", "tap", "push"};

struct Touched {
  double mass_kg, stiffness_N_m;  // 0: a wall
  std::string name() const {
    char text[32];
    std::snprintf(text, sizeof text, mass_kg > 0 ? "body %g kg" : "wall %g N/m", mass_kg > 0 ? mass_kg : stiffness_N_m);
    return text;
  }
};

struct Row {
  double generated_mJ = 0, observed_mJ = 0, error_mJ = 0, stiffness_N_m = 1e9, theory_N_m = 0, used = 1e9, factor = 1,
         delay_s = 0, peak_N = 1e9;
  bool cycle = false;

  void add(const DeviceEpisodeDef& def, const DeviceEpisodeResult& r) {
    generated_mJ = std::max(generated_mJ, r.generated_mJ);
    observed_mJ = std::max(observed_mJ, r.observed_mJ);
    error_mJ = std::max(error_mJ, std::abs(r.generated_mJ - r.observed_mJ));
    factor = std::min(factor, r.least_coupling);
    delay_s = std::max(delay_s, r.delay_s);
    peak_N = std::min(peak_N, r.peak_N);
    if (def.act != Act::kPress) return;
    cycle = cycle || r.cycles();
    const double share = r.stiffness_N_m / r.theory_N_m;
    if (share < used) used = share, stiffness_N_m = r.stiffness_N_m, theory_N_m = r.theory_N_m;
  }
  bool good(const Touched& surface) const {
    return generated_mJ <= kMaxGenerated_mJ && error_mJ <= kMaxError_mJ && !cycle &&
           (surface.mass_kg > 0 || used >= kUsed);
  }
};

void print_episode(const char* hand, const DeviceEpisodeDef& def, const DeviceEpisodeResult& r) {
  std::printf("  %-6s %-6s generated %7.3f observed %7.3f factor %5.3f sway %7.4f force %6.3f K %7.1f theory %7.1f\n", hand,
              kActs[static_cast<int>(def.act)], r.generated_mJ, r.observed_mJ, r.least_coupling, r.sway_N, r.force_N,
              r.stiffness_N_m, r.theory_N_m);
}

Row row_of(DeviceEpisodeDef def, const Touched& surface, bool all) {
  Row row;
  def.mass_kg = surface.mass_kg, def.stiffness_N_m = surface.stiffness_N_m;
  for (const HandKind& hand : device_hands())
    for (const Act act : {Act::kPress, Act::kTap, Act::kPush}) {
      if (act == Act::kPush && surface.mass_kg <= 0) continue;
      def.act = act, def.hand = hand.impedance;
      const DeviceEpisodeResult r = run_device_episode(def);
      row.add(def, r);
      if (all) print_episode(hand.name, def, r);
    }
  return row;
}

void print_heading() {
  std::printf("%-14s %8s %8s %8s %9s %9s %9s %6s %8s %8s %7s %7s\n", "surface", "Hz", "delay ms", "b N s/m",
              "gen. mJ", "seen mJ", "error mJ", "cycle", "K N/m", "theory", "used", "factor");
}

bool report(const Touched& surface, const DeviceEpisodeDef& def, double rate_Hz, const Row& row, nlohmann::json& rows) {
  const bool good = row.good(surface);
  std::printf("%-14s %8g %8g %8g %9.3f %9.3f %9.3f %6s %8.1f %8.1f %7.3f %7.3f%s\n", surface.name().c_str(), rate_Hz,
              def.delay_ms, def.damping_N_s_m, row.generated_mJ, row.observed_mJ, row.error_mJ, row.cycle ? "yes" : "no",
              row.stiffness_N_m, row.theory_N_m, row.used, row.factor, good ? "" : "  <- beyond its limits");
  std::fflush(stdout);
  rows.push_back({{"surface", surface.name()},
                  {"rate_Hz", rate_Hz},
                  {"delay_ms", def.delay_ms},
                  {"device_damping_N_s_m", def.damping_N_s_m},
                  {"generated_mJ", row.generated_mJ},
                  {"observed_mJ", row.observed_mJ},
                  {"error_mJ", row.error_mJ},
                  {"cycle", row.cycle},
                  {"stiffness_N_m", row.stiffness_N_m},
                  {"theory_N_m", row.theory_N_m},
                  {"used", row.used},
                  {"factor", row.factor},
                  {"loop_delay_s", row.delay_s},
                  {"peak_N", row.peak_N},
                  {"good", good}});
  return good;
}

}  // namespace

bool device_table(nlohmann::json& rows, bool full, bool all) {
  const std::vector<double> rates_Hz =
      full ? std::vector<double>{50, 100, 250, 500, 1000, 2000, 4000} : std::vector<double>{50, 250, 4000};
  const std::vector<double> delays_ms = full ? std::vector<double>{0, 1, 2, 5, 10} : std::vector<double>{0, 2, 10};
  const std::vector<Touched> surfaces = full ? std::vector<Touched>{{0, 200}, {0, 1000}, {0.05, 1000}, {0.2, 1000}, {0.5, 1000}, {2, 1000}}
                                             : std::vector<Touched>{{0, 1000}, {0.05, 1000}, {2, 1000}};
  std::printf("\ndevices with their own period, delay (each way) and damping\n");
  print_heading();
  bool good = true;
  for (const double damping : {10.0, 0.05})
    for (const Touched& surface : surfaces)
      for (const double rate_Hz : rates_Hz)
        for (const double delay_ms : delays_ms) {
          DeviceEpisodeDef def;
          def.device_Hz = rate_Hz, def.delay_ms = delay_ms;
          def.damping_N_s_m = def.settings.device_damping_Ns_m = damping;
          good = report(surface, def, rate_Hz, row_of(def, surface, all), rows) && good;
        }
  return good;
}

bool rate_table(nlohmann::json& rows) {
  std::printf("\ntick rates of the node, with a device that is read and commanded in the tick\n");
  print_heading();
  bool good = true;
  for (const double rate_Hz : {100.0, 150.0, 250.0, 500.0, 1000.0, 4000.0})
    for (const Touched& surface : {Touched{0, 1000}, Touched{0.2, 1000}}) {
      DeviceEpisodeDef def;
      def.device_Hz = 0, def.damping_N_s_m = 0, def.settings.rate_Hz = rate_Hz;
      good = report(surface, def, rate_Hz, row_of(def, surface, false), rows) && good;
    }
  return good;
}

}  // namespace tactus::bench
