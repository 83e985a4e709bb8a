// Errors of scenes with a known outcome, solved by impulses and joint coordinates (ours), and by ODE alone.
//
//    bin/proof_table [--json FILE] [--stand SECONDS]     the error of each proof; exits 1 when one of ours is over its limit
//
// Stacks stand 60 s, which takes ODE's exact solver minutes; --stand shortens it.
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "sync/node/node_options.h"
#include "tests/bench/sim_node/proofs.h"

using namespace tactus::bench;

int main(int argc, char** argv) {
  tactus::sync::Arguments app("Errors of the simulation against closed forms");
  std::string json;
  double stand_s = 60;
  app.add_option("--json", json, "Writes the figures here");
  app.add_option("--stand", stand_s, "How long stacks have to stand, s").range(0.1, 600.0);
  tactus::sync::parse_or_exit(app, "proof_table", argc, argv);

  std::vector<Proof> proofs = free_proofs();
  for (auto& more : {contact_proofs(stand_s), joint_proofs()})
    proofs.insert(proofs.end(), more.begin(), more.end());
  std::printf("%-42s %-7s %10s %12s %12s %12s   %-36s %s\n", "proof", "unit", "limit", "ours", "ODE step",
              "ODE quick", "truth", "the limit is there because");
  auto rows = nlohmann::ordered_json::array();
  bool good = true;
  for (const Proof& p : proofs) {
    const double ours = p.error(make_ours), step = p.error([] { return make_ode(false); }),
                 quick = p.error([] { return make_ode(true); });
    const bool holds = ours <= p.limit;  // false for NaN
    good &= holds;
    std::printf("%-42s %-7s %10.2g %12.3g %12.3g %12.3g %c %-36s %s\n", p.what.c_str(), p.unit.c_str(), p.limit,
                ours, step, quick, holds ? ' ' : '!', p.truth.c_str(), p.why.c_str());
    std::fflush(stdout);
    rows.push_back({{"proof", p.what},
                    {"unit", p.unit},
                    {"limit", p.limit},
                    {"ours", ours},
                    {"holds", holds},
                    {"ode_step", step},
                    {"ode_quick", quick},
                    {"truth", p.truth},
                    {"limit_because", p.why}});
  }
  if (!json.empty()) std::ofstream(json) << rows.dump(1) << "\n";
  return good ? 0 : 1;
}
