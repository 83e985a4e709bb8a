// Cost of a world in two groups: a haptic tick against the number of bodies, and a second of the world against one that is simulated whole
// at the haptic rate.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "sim_node/world/simulation.h"
#include "sim_node/dual/dual_groups.h"
#include "sync/node/node_options.h"
#include "tests/sim_node/support/simple_hand.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;

namespace {

// Time of this thread alone. Other programs affect it only by evicting data from the caches.
double cpu_us() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

double quantile(std::vector<double> v, double q) {
  if (v.empty()) return 0;
  const auto at = v.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(v.size() - 1));
  std::nth_element(v.begin(), at, v.end());
  return *at;
}

// Balls that roll on a plane, each in its own place; the first four are near the tool, which is at the origin.
WorldDef rolling(int balls, double speed_m_s, bool by_the_tool = true) {
  WorldDef w = empty_world();
  add_floor(w, 0.3, 0.5);
  const int side = static_cast<int>(std::ceil(std::sqrt(balls)));
  for (int i = 0; i < balls; ++i) {
    const double x = 1 + 0.2 * (i % side), y = 1 + 0.2 * (i / side);
    const bool near = by_the_tool && i < 4;
    const int body = near
                         ? add_ball(w, 0.2, 0.03, {0.07 * (i % 2) - 0.035, 0.07 * (i / 2) - 0.035, 0.03}, 0.3, 0.5)
                         : add_ball(w, 0.2, 0.03, {x, y, 0.03}, 0.3, 0.5);
    // In alternating directions, so that neighbours do not meet.
    if (!near) w.bodies[static_cast<std::size_t>(body)].velocity_m_s = {speed_m_s, 0.3 * speed_m_s, 0};
  }
  add_tool(w, {0, 0, 0.05});
  return w;
}

// Boxes that slide on a plane without friction, so that none comes to rest.
WorldDef sliding(int boxes, double speed_m_s) {
  WorldDef w = empty_world();
  add_floor(w, 0, 0);
  const int side = static_cast<int>(std::ceil(std::sqrt(boxes)));
  for (int i = 0; i < boxes; ++i) {
    const int body = add_box(w, 0.5, {0.1, 0.1, 0.1}, at(1 + 0.3 * (i % side), 1 + 0.3 * (i / side), 0.05));
    w.bodies[static_cast<std::size_t>(body)].velocity_m_s = {speed_m_s, 0.3 * speed_m_s, 0};
  }
  add_tool(w, {0, 0, 0.05});
  return w;
}

WorldDef towers(int boxes, int high) {
  WorldDef w = empty_world();
  add_floor(w);
  for (int i = 0; i < boxes; ++i)
    add_box(w, 0.5, {0.1, 0.1, 0.1},
            at(1 + 0.3 * ((i / high) % 10), 1 + 0.3 * ((i / high) / 10), 0.05 + 0.1 * (i % high)));
  return w;
}

Settings settings_for(bool dual, int substeps, const char* thread) {
  Settings s;
  s.solver = "impulse";
  s.detector = "auto";
  s.groups = dual ? "dual" : "single";
  s.visual_substeps = substeps;
  s.visual_thread = thread;
  return s;
}

// One row: a tick of the loop in the time of this thread, paced as the loop is.
nlohmann::json tick_row(int balls, int ticks) {
  Simulation s(rolling(balls, 0.2), settings_for(true, 4, "own"));
  s.start(1);
  std::vector<double> all, begins;
  auto due = std::chrono::steady_clock::now();
  std::int64_t late = 0;
  for (int i = 0; i < ticks; ++i) {
    due += std::chrono::milliseconds(1);
    std::this_thread::sleep_until(due);
    const double before = cpu_us();
    s.step({});
    const double us = cpu_us() - before;
    if (i < ticks / 10) continue;
    const LookAhead* look_ahead = s.look_ahead();
    all.push_back(us);
    if (look_ahead && look_ahead->fresh) begins.push_back(us);
  }
  const auto& groups = dynamic_cast<const DualGroups&>(s.mechanics());
  late = groups.late_steps();
  return {{"bodies", balls},
          {"group", groups.haptic().size()},
          {"median_us", quantile(all, 0.5)},
          {"p99_us", quantile(all, 0.99)},
          {"begin_us", quantile(begins, 0.5)},
          {"late_steps", late}};
}

// Processor time of a simulated second, over all that a tick does. The visual steps are computed within the ticks.
double second_us(Simulation& s, int ticks) {
  const double before = cpu_us();
  for (int i = 0; i < ticks; ++i) s.step({});
  return (cpu_us() - before) * 1000 / ticks;
}

nlohmann::json whole_row(const char* what, const WorldDef& world, int settle, int ticks, int rounds) {
  Simulation single(world, settings_for(false, 1, "none")), one(world, settings_for(true, 1, "none")),
      four(world, settings_for(true, 4, "none"));
  for (Simulation* s : {&single, &one, &four}) {
    s->start(1);
    second_us(*s, settle);
  }
  std::vector<double> a, b, c;
  for (int round = 0; round < rounds; ++round) {
    a.push_back(second_us(single, ticks));
    b.push_back(second_us(one, ticks));
    c.push_back(second_us(four, ticks));
  }
  const double whole = quantile(a, 0.5), sixty = quantile(b, 0.5), divided = quantile(c, 0.5);
  const auto& groups = dynamic_cast<const DualGroups&>(one.mechanics());
  return {
      {"what", what},         {"asleep", groups.step()->asleep}, {"single_us", whole},        {"dual_us", sixty},
      {"dual_4_us", divided}, {"ratio", whole / sixty},          {"ratio_4", whole / divided}};
}

void ticks_table(int ticks, nlohmann::json& out) {
  std::printf(
      "a haptic tick, four balls near the tool, all others rolling; this thread's time, us\n%8s %8s %10s %10s "
      "%14s %8s\n",
      "bodies", "group", "median", "p99", "step begins", "late");
  for (const int n : {10, 100, 300, 1000, 3000}) {
    const nlohmann::json r = tick_row(n, ticks);
    std::printf("%8d %8d %10.1f %10.1f %14.1f %8d\n", n, r["group"].get<int>(), r["median_us"].get<double>(),
                r["p99_us"].get<double>(), r["begin_us"].get<double>(), r["late_steps"].get<int>());
    out["tick"].push_back(r);
  }
  std::printf("median with 3,000 by that with 10: %.2f\n\n",
              out["tick"].back()["median_us"].get<double>() / out["tick"].front()["median_us"].get<double>());
}

}  // namespace

int main(int argc, char** argv) {
  tactus::sync::Arguments app{"Cost of a world in two groups, and of one that is simulated as a whole at 1 kHz."};
  int ticks = 3000, rounds = 5;
  std::string json, only;
  app.add_option("--ticks", ticks, "of each row of the first table")
      .show_default()
      .positive();
  app.add_option("--rounds", rounds, "of each row of the second")
      .show_default()
      .positive();
  app.add_option("--only", only, "rows of the second whose name has this in it, and no first");
  app.add_option("--json", json, "write the tables here too");
  tactus::sync::parse_or_exit(app, "dual_table", argc, argv);
  nlohmann::json out;
  if (only.empty()) ticks_table(ticks, out);
  std::printf(
      "processor time of a simulated second, ms; ratio: of simulating all at 1 kHz\n%-34s %8s %10s %10s %8s %12s "
      "%8s\n",
      "", "asleep", "at 1 kHz", "60 Hz", "ratio", "60 Hz in 4", "ratio");
  for (const auto& [what, world, settle] :
       {std::tuple{"500 balls rolling, 4 by the tool", rolling(500, 0.2), 1500},
        std::tuple{"500 balls rolling, the tool alone", rolling(500, 0.2, false), 1500},
        std::tuple{"500 boxes sliding, the tool alone", sliding(500, 0.2), 1500},
        std::tuple{"500 boxes in towers of 5, awake", towers(500, 5), 20},
        std::tuple{"500 boxes in towers of 5, at rest", towers(500, 5), 1500}}) {
    if (std::string_view(what).find(only) == std::string_view::npos) continue;
    const nlohmann::json r = whole_row(what, world, settle, 100, rounds);
    std::printf("%-34s %8d %10.1f %10.1f %8.1f %12.1f %8.1f\n", what, r["asleep"].get<int>(),
                r["single_us"].get<double>() / 1e3, r["dual_us"].get<double>() / 1e3, r["ratio"].get<double>(),
                r["dual_4_us"].get<double>() / 1e3, r["ratio_4"].get<double>());
    out["second"].push_back(r);
  }
  if (!json.empty()) std::ofstream(json) << out.dump(1) << "\n";
}
