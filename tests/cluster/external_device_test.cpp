// Tests of devices with drivers in separate programs, in C++ and in Python: connection, rendering, loss and reconnection.
#include <signal.h>

#include <cstdlib>
#include <tactus/node_health_t.hpp>
#include <tactus/tool_state_t.hpp>

#include "tests/cluster/support/running.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

// Generates lcm-gen's types for Python in the test's folder.
std::filesystem::path python_types(const Folder& folder) {
  const auto types = folder.path() / "types";
  const std::string command = "lcm-gen -p --ppath " + quoted(types.string()) + " " +
                              quoted((repository() / "lcmtypes").string()) + "/types/*/*.lcm";
  REQUIRE(std::system(command.c_str()) == 0);
  return types;
}

struct ClusterWithDriver : RunningCluster {
  // Starts touch with an external device, without a driver.
  void start_touch() {
    processes.start("sim_node", {tapping_scene()});
    processes.start("haptic_node", {"--device", "external:arm"});
    const bool waits =
        monitor.wait_until([&] { return state("haptic_node", node_health_t::OUTPUT_LOST); }, kTimeout_s);
    INFO(processes.output("haptic_node"));
    REQUIRE(waits);
  }
  void start_driver(const std::string& language) {
    const std::string run = std::to_string(kRunId);
    if (language == "C++") {
      processes.spawn("driver", {(programs() / "device_driver").string(), "arm", channels::kGroup, "7667", run});
    } else {
      const auto driver = (repository() / "examples/device_driver/driver.py").string();
      processes.spawn("driver", {"env", "PYTHONPATH=" + python_types(folder).string(), "/usr/bin/python3", driver,
                                 "arm", channels::kGroup, "7667", run});
    }
  }
  // The spring of 300 N/m pulls the weight 5 mm under the floor. States every 4 ms allow the coupling 667 N/m, so 1.37 N remain at rest,
  // and 1.1 N when a force takes one more interval.
  bool is_felt() {
    return monitor.wait_until([&] { return is_running("haptic_node") && monitor.force_N() > 0.7; }, kTimeout_s);
  }
  bool is_lost() {
    return monitor.wait_until([&] { return state("haptic_node", node_health_t::OUTPUT_LOST) && monitor.force_N() == 0; },
                          kTimeout_s);
  }
};

}  // namespace

TEST_CASE("A device driven by a program is felt, lost when the program is killed or frozen, and felt again") {
  const std::string language = GENERATE("C++", "Python");
  CAPTURE(language);
  ClusterWithDriver c;
  c.start_touch();
  c.start_driver(language);
  const bool felt = c.is_felt();
  INFO(c.processes.output("driver") << c.processes.output("haptic_node"));
  REQUIRE(felt);

  // The weight rests where its spring and the floor balance: above its rest position, which is 5 mm under the floor.
  const tool_state_t* tool = c.monitor.tool_state();
  REQUIRE(tool);
  CHECK(tool->device.position_m.z > -0.005);

  c.processes.signal("driver", SIGSTOP);
  CHECK(c.is_lost());
  c.processes.signal("driver", SIGCONT);
  CHECK(c.is_felt());

  c.processes.kill("driver");
  CHECK(c.is_lost());
  CHECK(c.processes.running("haptic_node"));
  c.start_driver(language);
  CHECK(c.is_felt());
  CHECK(c.monitor.malformed("haptic_node") == 0);
}

TEST_CASE("A simulated string device taps the floor like any other hand") {
  RunningCluster c;
  c.processes.start("sim_node", {tapping_scene()});
  c.processes.start("haptic_node", {"--device", "spidar:desktop,offset=0/0/0.03"});
  const bool felt = c.monitor.wait_until([&] { return c.is_running("haptic_node") && c.monitor.force_N() > 0.5; }, kTimeout_s);
  INFO(c.processes.output("haptic_node"));
  REQUIRE(felt);
  CHECK(c.monitor.wait_until([&] { return c.monitor.hits() >= 3; }, kTimeout_s));
}

TEST_CASE("A device driven by two programs is lost until one of them ends") {
  ClusterWithDriver c;
  c.start_touch();
  c.start_driver("C++");
  REQUIRE(c.is_felt());
  c.processes.spawn("second", {(programs() / "device_driver").string(), "arm"});
  CHECK(c.is_lost());
  c.processes.kill("second");
  CHECK(c.is_felt());
}
