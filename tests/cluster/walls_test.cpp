// Tests of two walls of one room, each drawn by a process of its own.
#include <csignal>

#include "tests/cluster/support/running.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

struct TwoWalls : RunningCluster {
  static constexpr const char* kLeft = "visual_node";
  static constexpr const char* kFront = "visual_node_front";
  std::vector<std::string> nodes = kNodes;

  TwoWalls() { nodes.push_back(kFront); }
  static std::vector<std::string> wall_options(const std::string& wall) {
    return {"--no-video", "--set",     "room=cave4", "--set",     "wall=" + wall,
            "--set",      "width=320", "--set",      "height=320"};
  }
  void start_all() {
    processes.start("sync_node");
    for (const char* node : {"haptic_node", "audio_node", "thermal_node"}) processes.start(node);
    processes.start(kLeft, wall_options("left"));
    start_front();
    processes.start("sim_node", {tapping_scene()});
    const bool alive = monitor.wait_until([&] { return all_running(nodes) && monitor.hits() > 0; }, kTimeout_s);
    UNSCOPED_INFO(log_text());
    REQUIRE(alive);
  }
  void start_front() {
    std::vector<std::string> words{
        programs() / "visual_node", "--run-id", std::to_string(kRunId), "--out", folder.path(), "--name", kFront};
    const auto options = wall_options("front");
    words.insert(words.end(), options.begin(), options.end());
    processes.spawn(kFront, words);
  }
  bool keeps_rendering(const std::string& node) {
    const std::int64_t before = monitor.rendered(node);
    return monitor.wait_until([&] { return monitor.rendered(node) > before + 2; }, kTimeout_s);
  }
};

}  // namespace

TEST_CASE(
    "Each of two walls of a room shows every event, and a frozen or killed wall does not disturb the "
    "other processes") {
  TwoWalls c;
  c.start_all();
  CHECK(c.keeps_rendering(TwoWalls::kLeft));
  CHECK(c.keeps_rendering(TwoWalls::kFront));
  const auto before = c.rates(1);

  c.processes.signal(TwoWalls::kFront, SIGSTOP);
  c.check_rates_hold(before, 2);
  CHECK(c.keeps_rendering(TwoWalls::kLeft));
  c.processes.signal(TwoWalls::kFront, SIGCONT);
  CHECK(c.monitor.wait_until([&] { return c.all_running(c.nodes); }, kTimeout_s));
  CHECK(c.keeps_rendering(TwoWalls::kFront));

  c.processes.kill(TwoWalls::kFront);
  c.check_rates_hold(before, 2);
  CHECK(c.keeps_rendering(TwoWalls::kLeft));
  c.start_front();
  CHECK(c.monitor.wait_until([&] { return c.all_running(c.nodes); }, kTimeout_s));
  CHECK(c.keeps_rendering(TwoWalls::kFront));
}
