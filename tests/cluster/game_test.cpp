// The dark room's game, played by the scene's hand with real processes.
#include <nlohmann/json.hpp>

#include "tests/cluster/run_script.h"

using namespace tactus::cluster;
using nlohmann::json;

TEST_CASE("The hand of the dark room, and a string device in its place, push every ball into its hole") {
  // What drives a simulated string device is the same hand, whose pose comes from the lengths of strings, whose
  // force from tensions.
  const std::string device = GENERATE("virtual_hand", "spidar:cave,offset=-0.1/0/0.2");
  RunScript run;
  run.start({"--seconds", "20", "--device", device, "--without", "visual_node", "--without", "audio_node",
             "--without", "thermal_node", "--out", run.out()});
  const int status = run.finish(150);
  INFO(device << ": " << run.processes.said("run"));
  CHECK(status == 0);
  const json summary = json::parse(contents(run.out() / "summary.json"), nullptr, false);
  REQUIRE_FALSE(summary.is_discarded());
  CHECK(summary["game"]["filled"] == 3);
  REQUIRE(summary["game"]["won_at_s"].is_number());
  // The path is over its last hole 17.5 s after its begin.
  CHECK(summary["game"]["won_at_s"].get<double>() < 19);
  CHECK(summary["contacts"]["by_modality"]["haptic"]["lost"] == 0);
}
