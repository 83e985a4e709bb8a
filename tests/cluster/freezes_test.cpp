// Tests of stopped processes (SIGSTOP): the force ends, returns only through a fade, and never passes a limit, as the driver of
// a device exerts it. tests/measure/measure_freezes measures the times.
#include <signal.h>

#include <array>
#include <tactus/node_health_t.hpp>
#include <tactus/thermal_state_t.hpp>

#include "sync/clocks/pacing.h"
#include "tests/cluster/support/exerted_force.h"
#include "tests/cluster/support/running.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

constexpr double kFelt_N = 0.3;
constexpr std::array kStops_s{0.03, 0.2, 1.0};

// A command is valid for 20 ms after its arrival, at most 50 ms after it was sent, and fades within 20 ms; a driver that is held
// up for more than 20 ms begins from zero.
constexpr std::int64_t kCommandOver_ns = 120'000'000;

struct PressedCluster : RunningCluster {
  PressedCluster() {
    states = &monitor.bus().queue<device_state_t>(channels::kDeviceState, 20'000);
    commands = &monitor.bus().queue<thermal_state_t>(channels::kThermalState, 2'000);
    processes.start("sync_node");
    processes.start("haptic_node", {"--tool", "hand"});
    processes.start("audio_node");
    processes.start("thermal_node", {"--tool", "hand", "--set", "device=external"});
    processes.start("thermal_device", {"--tool", "0"});
    processes.start("visual_node", {"--no-video"});
    processes.start("sim_node", {(repository() / "tests/cluster/scenes/pressed_and_tapped.sdf").string()});
    processes.spawn("arm_driver", {(programs() / "device_driver").string(), "arm", channels::kGroup, "7667", std::to_string(kRunId)});
  }
  void receive() {
    force.receive(*states);
    while (const auto m = commands->pop()) {
      lowest_degC = std::min(lowest_degC, static_cast<double>(m->message.commanded_degC));
      highest_degC = std::max(highest_degC, static_cast<double>(m->message.commanded_degC));
    }
  }
  bool wait_until(const std::function<bool()>& condition) {
    return monitor.wait_until([&] { return receive(), condition(); }, kTimeout_s);
  }
  bool is_felt() {
    const std::int64_t since_ns = sync::to_ns(sync::host_now());
    return wait_until([&] { return !force.ticks().empty() && force.ticks().back().after_ns > since_ns && std::abs(force.ticks().back().force_N) > kFelt_N; });
  }
  bool is_zero() {
    const std::int64_t since_ns = sync::to_ns(sync::host_now());
    return wait_until([&] { return !force.ticks().empty() && force.ticks().back().after_ns > since_ns && std::abs(force.ticks().back().force_N) < 1e-3; });
  }

  sync::Queue<device_state_t>* states;
  sync::Queue<thermal_state_t>* commands;
  ExertedForce force;
  double lowest_degC = 33, highest_degC = 33;
};

// Stops a process for this time; checks the force meanwhile and that it is felt again.
void stop_once(PressedCluster& c, const std::string& process, double seconds) {
  c.processes.signal(process, SIGSTOP);
  const std::int64_t begin_ns = sync::to_ns(sync::host_now());
  // A longer stop lasts until the loss is known, which takes longer on a loaded machine.
  if (seconds >= 1 && process == "sim_node") {
    CHECK(c.wait_until([&] { return c.state("haptic_node", node_health_t::INPUT_LOST); }));
    CHECK(c.is_zero());
  }
  if (seconds >= 1 && process == "arm_driver")
    CHECK(c.wait_until([&] { return c.state("haptic_node", node_health_t::OUTPUT_LOST) && c.monitor.force_N() == 0; }));
  if (seconds >= 1 && process == "haptic_node") CHECK(c.is_zero());
  const std::int64_t lost_ns = sync::to_ns(sync::host_now());
  c.monitor.receive_for(seconds);
  c.receive();
  const std::int64_t end_ns = sync::to_ns(sync::host_now());
  if (process == "haptic_node") CHECK(c.force.largest_N(begin_ns + kCommandOver_ns, end_ns) < 1e-3);
  if (process == "sim_node" && seconds >= 1) CHECK(c.force.largest_N(lost_ns, end_ns) < 1e-3);
  c.processes.signal(process, SIGCONT);
  CHECK(c.is_felt());
}

}  // namespace

TEST_CASE("While any process is stopped no force remains, and afterwards it returns through a fade") {
  PressedCluster c;
  const bool felt = c.is_felt();
  INFO(c.processes.output("haptic_node") << c.processes.output("arm_driver"));
  REQUIRE(felt);
  // The weight has landed and rests.
  c.monitor.receive_for(1);
  c.receive();
  c.force.clear();
  for (const char* process : {"sim_node", "haptic_node", "arm_driver", "thermal_node", "thermal_device", "audio_node", "visual_node", "sync_node"})
    for (const double seconds : kStops_s) {
      INFO(process << " is stopped for " << seconds << " s");
      stop_once(c, process, seconds);
      CHECK(c.processes.running(process));
    }
  CHECK(c.force.faults() == "");
  CHECK(c.lowest_degC >= 15 - 1e-3);
  CHECK(c.highest_degC <= 42 + 1e-3);
  CHECK(c.wait_until([&] { return c.is_running("haptic_node") && c.is_running("sim_node"); }));
}
