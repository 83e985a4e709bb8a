// Tests of settings of a running node, changed by the command line program.
#include <cmath>
#include <tactus/tool_state_t.hpp>

#include "sync/bus/bus.h"
#include "tests/cluster/support/running.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

struct SetCluster : RunningCluster {
  int call_count = 0;

  std::string run_set(const std::vector<std::string>& words, int wanted_status = 0) {
    const std::string name = "set" + std::to_string(++call_count);
    std::vector<std::string> command{programs() / "set", "--run-id", std::to_string(kRunId)};
    command.insert(command.end(), words.begin(), words.end());
    processes.spawn(name, command);
    const int status = processes.wait_for_exit(name, kTimeout_s);
    INFO(processes.output(name));
    CHECK(status == wanted_status);
    const std::string output = processes.output(name);
    CHECK(std::count(output.begin(), output.end(), '\n') == 1);
    return output;
  }
  // The largest force in TOOL_STATE over the given time, N: the hand taps twice per second.
  double max_force_N(double seconds) {
    double max = 0;
    std::int64_t states = 0;
    sync::Bus bus(sync::Identity::fresh("listener", kRunId), {});
    auto& queue = bus.queue<tool_state_t>(channels::kToolState, 8192);
    const sync::HostTime end = sync::host_now() + sync::from_seconds(seconds);
    while (sync::host_now() < end) {
      bus.wait(sync::Nanoseconds(20'000'000));
      bus.drain(sync::host_now());
      while (auto m = queue.pop()) {
        ++states;
        max =
            std::max<double>(max, std::hypot(m->message.force_N.x, m->message.force_N.y, m->message.force_N.z));
      }
    }
    REQUIRE(states > 100);
    return max;
  }
};

}  // namespace

TEST_CASE("A force limit lowered during taps holds from the reply on, and can be raised to its former value", "[smoke]") {
  SetCluster c;
  c.start();
  const double before_N = c.max_force_N(2);
  REQUIRE(before_N > 1);
  CHECK_THAT(c.run_set({"haptic_node", "force_limit=0.5N"}), Catch::Contains("force_limit"));
  const double lowered_N = c.max_force_N(2);
  CHECK(lowered_N <= 0.5 + 1e-6);
  CHECK(lowered_N > 0.4);  // the setting limits the force and does not end touch
  c.run_set({"haptic_node", "force_limit=8N"});
  CHECK(c.max_force_N(2) > 0.8 * before_N);
  CHECK(c.monitor.wait_until([&] { return c.is_running("haptic_node"); }, kTimeout_s));
}

TEST_CASE("A running node rejects forbidden and impossible settings with a sentence, and keeps its values", "[smoke]") {
  SetCluster c;
  c.start();
  CHECK_THAT(c.run_set({"haptic_node", "force_limit=20N"}, 1), Catch::Contains("force_limit"));
  CHECK_THAT(c.run_set({"haptic_node", "rate=2000Hz"}, 1), Catch::Contains("rate"));
  CHECK_THAT(c.run_set({"haptic_node", "nonsense=1"}, 1), Catch::Contains("nonsense"));
  CHECK_THAT(c.run_set({"haptic_node", "force_limit=much"}, 1), Catch::Contains("force_limit"));
  CHECK_THAT(c.run_set({"nose_node", "force_limit=1N"}, 1), Catch::Contains("nose_node"));
  CHECK_THAT(c.run_set({"haptic_node", "force_limit"}, 1), Catch::Contains("NAME=VALUE"));
  CHECK(c.max_force_N(2) > 1);
  CHECK(c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s));
}
