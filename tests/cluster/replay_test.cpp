// Tests of a log replayed by the stock lcm-logplayer to running renderers.
#include <signal.h>

#include "sync/bus/bus.h"
#include "tests/cluster/support/running.h"

using namespace tactus;
using namespace tactus::cluster;

TEST_CASE("audio_node and visual_node render a log that the stock lcm-logplayer replays", "[smoke]") {
  Folder folder;
  {
    RunningCluster c;
    c.processes.start("recorder");
    c.start();
    c.monitor.receive_for(4);
    CHECK(c.monitor.rendered("audio_node") > 0);
    c.processes.signal("recorder", SIGTERM);
    REQUIRE(c.processes.wait_for_exit("recorder", kTimeout_s) == 0);
    REQUIRE(std::filesystem::exists(c.folder.path() / "run.lcmlog"));
    std::filesystem::rename(c.folder.path() / "run.lcmlog", folder.path() / "run.lcmlog");
  }
  const std::filesystem::path log = folder.path() / "run.lcmlog";

  // Another run, without a simulation.
  constexpr std::int64_t kOtherRun = RunningCluster::kRunId + 1;
  Processes processes(folder.path() / "again", kOtherRun);
  ClusterMonitor monitor(kOtherRun);
  processes.start("audio_node");
  processes.start("visual_node");
  REQUIRE(monitor.wait_until([&] { return monitor.health("audio_node") && monitor.health("visual_node"); }, kTimeout_s));
  CHECK(monitor.rendered("audio_node") == 0);
  CHECK(monitor.rendered("visual_node") == 0);
  processes.spawn("lcm-logplayer", {"lcm-logplayer", "-l", "udpm://239.255.76.67:7667?ttl=0", log});
  CHECK(monitor.wait_until([&] { return monitor.rendered("audio_node") > 0; }, kTimeout_s));
  CHECK(monitor.wait_until([&] { return monitor.rendered("visual_node") > 0; }, kTimeout_s));
  CHECK(processes.wait_for_exit("lcm-logplayer", kTimeout_s) == 0);
  CHECK(processes.running("audio_node"));
  CHECK(processes.running("visual_node"));
}
