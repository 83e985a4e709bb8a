// Tests of the dark room's game with real processes, played by the scene's virtual hand.
#include <nlohmann/json.hpp>

#include "tests/cluster/support/run_script.h"

using namespace tactus::cluster;
using nlohmann::json;

namespace {

// The hand follows the clock with closed eyes. If the machine stops the simulation for longer than this, the hand moves past the ball
// meanwhile. Such a run says nothing about the scene and is repeated.
constexpr double kStandstillUs = 20000;

double longest_standstill_us(const json& summary) {
  const json& sim = summary["nodes"]["sim_node"];
  return std::max(sim["wake_us"]["max"].get<double>(), sim["tick_us"]["max"].get<double>());
}

}  // namespace

TEST_CASE("A live simulated player pushes every ball into its hole, and none without a picture") {
  for (const bool seen : {true, false}) {
    RunScript run;
    std::vector<std::string> words{"--seconds", "20", "--player", "--without", "audio_node", "--without", "thermal_node", "--out", run.out(),
                                   "--set", "visual_node.width=320", "--set", "visual_node.height=240"};
    if (!seen) words.insert(words.end(), {"--without", "visual_node"});
    run.start(words);
    const int status = run.finish(150);
    INFO((seen ? "seen: " : "unseen: ") << run.processes.output("run"));
    CHECK(status == 0);
    const json summary = json::parse(contents(run.out() / "summary.json"), nullptr, false);
    REQUIRE_FALSE(summary.is_discarded());
    if (seen)
      CHECK(summary["game"]["filled"] == 3);
    else
      CHECK(summary["game"]["filled"] < 3);
  }
}

TEST_CASE("The hand of the dark room, or a string device, pushes every ball into its hole") {
  // The simulated string device is driven by the same hand; its pose comes from string lengths, its force from tensions.
  const std::string device = GENERATE("virtual_hand", "spidar:cave,offset=-0.1/0/0.2");
  for (int attempt = 1;; ++attempt) {
    RunScript run;
    run.start({"--seconds", "20", "--device", device, "--without", "visual_node", "--without", "audio_node",
               "--without", "thermal_node", "--out", run.out()});
    const int status = run.finish(150);
    INFO(device << ", attempt " << attempt << ": " << run.processes.output("run"));
    CHECK(status == 0);
    const json summary = json::parse(contents(run.out() / "summary.json"), nullptr, false);
    REQUIRE_FALSE(summary.is_discarded());
    if (attempt < 3 && summary["game"]["filled"] != 3 && longest_standstill_us(summary) > kStandstillUs) {
      WARN("the machine held the world still for " << longest_standstill_us(summary) / 1000 << " ms; once more");
      continue;
    }
    INFO("the world stood still for at most " << longest_standstill_us(summary) / 1000 << " ms");
    CHECK(summary["game"]["filled"] == 3);
    REQUIRE(summary["game"]["won_at_s"].is_number());
    // The path passes its last hole 17.5 s after its begin.
    CHECK(summary["game"]["won_at_s"].get<double>() < 19);
    CHECK(summary["contacts"]["by_modality"]["haptic"]["lost"] == 0);
    break;
  }
}
