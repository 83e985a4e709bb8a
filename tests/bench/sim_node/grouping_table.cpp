// Number of contacts that two rules of grouping miss, and size of the group, for a hand with arbitrary acceleration: the table behind
// sim_node/dual/grouping.h.
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <tuple>

#include "sync/node/node_options.h"
#include "tests/sim_node/support/adversary.h"

using namespace tactus::sim;

int main(int argc, char** argv) {
  tactus::sync::Arguments app{"Contacts missed by grouping, and sizes of the group, against an adversarial tool."};
  int scenes = 10, steps = 120, balls = 60;
  std::string json;
  app.add_option("--scenes", scenes, "random scenes a row").show_default().positive();
  app.add_option("--steps", steps, "visual steps of each").show_default().positive();
  app.add_option("--balls", balls, "in a room of 0.6 m").show_default().positive();
  app.add_option("--json", json, "write the table here too");
  tactus::sync::parse_or_exit(app, "grouping_table", argc, argv);
  nlohmann::json table = nlohmann::json::array();
  std::printf("%d scenes of %d balls in a room of 0.6 m, %d visual steps each; tool at most 1 m/s, bang-bang\n\n",
              scenes, balls, steps);
  std::printf("%-22s %-18s %9s %8s %12s %8s %12s %8s\n", "tool's acceleration", "rule", "contacts", "missed",
              "deepest, mm", "group", "/ hindsight", "alarms");
  for (const double acceleration : {0.0, 9.8, 30.0, 100.0, 300.0})
    for (const auto& [name, rule, stay_s] : {std::tuple{"sound", GroupingRule::kSound, 0.0},
                                             std::tuple{"sound, stays 0.1 s", GroupingRule::kSound, 0.1},
                                             std::tuple{"kim2005", GroupingRule::kKim2005, 0.0}}) {
      test::AdversaryResult sum;
      for (int scene = 0; scene < scenes; ++scene) {
        test::AdversaryDef def;
        def.balls = balls;
        def.steps = steps;
        def.tool_acceleration_m_s2 = acceleration;
        def.seed = static_cast<unsigned>(scene + 1);
        GroupingLimits limits;
        limits.leave_after = tactus::sync::from_seconds(stay_s);
        const test::AdversaryResult r = test::Adversary(def, rule, limits).run();
        sum.contacts += r.contacts, sum.missed += r.missed, sum.alarms += r.alarms;
        sum.deepest_missed_m = std::max(sum.deepest_missed_m, r.deepest_missed_m);
        sum.group += r.group / scenes, sum.touched += r.touched / scenes;
      }
      std::printf("%16.1f m/s^2 %-18s %9ld %8ld %12.1f %8.2f %12.1f %8ld\n", acceleration, name, sum.contacts,
                  sum.missed, sum.deepest_missed_m * 1e3, sum.group, sum.group / sum.touched, sum.alarms);
      table.push_back({{"tool_acceleration_m_s2", acceleration},
                       {"rule", name},
                       {"contacts", sum.contacts},
                       {"missed", sum.missed},
                       {"deepest_missed_m", sum.deepest_missed_m},
                       {"group", sum.group},
                       {"hindsight", sum.touched},
                       {"alarms", sum.alarms}});
    }
  if (!json.empty()) std::ofstream(json) << table.dump(1) << "\n";
}
