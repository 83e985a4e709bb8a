// Two simulated machines: the namespaces of the test and a second network with a cable between them, where the system allows it with a
// clock that is an hour ahead. Touch and the simulation run on the first, sound, picture and heat on the second.
#pragma once

#include <signal.h>

#include <fstream>
#include <optional>
#include <tactus/sync_report_t.hpp>

#include "tests/cluster/support/running.h"

namespace tactus::cluster {

inline const std::vector<std::string> kRemoteNodes{"audio_node", "visual_node", "thermal_node"};

// Must exist before any program listens: a socket that joined a group on the old route would not receive from the cable.
class Cable {
 public:
  Cable() : processes_(folder_.path(), 1) {
    // One time namespace for all processes there, because each time namespace is a clock of its own.
    std::vector<std::string> machine{"unshare", "--net"};
    clock_ = run("unshare --time --monotonic 3600 --fork true");
    if (clock_) machine.insert(machine.end(), {"--time", "--monotonic", "3600", "--fork", "--kill-child"});
    machine.insert(machine.end(), {"sh", "-c", "echo $$ > " + pid_file() + "; exec sleep 100000"});
    processes_.spawn("machine", machine);
    const bool up = run("for i in $(seq 500); do [ -s " + pid_file() + " ] && exit 0; sleep 0.01; done; exit 1");
    if (!up) return;
    std::ifstream(pid_file()) >> pid_;
    ready_ = run(
        "set -e; ip link add cable type veth peer name cable_there; ip link set cable_there netns " +
        std::to_string(pid_) +
        "; ip addr add 10.77.0.1/24 dev cable; ip link set cable up; ip route replace 224.0.0.0/4 dev cable; " +
        "nsenter --net=" + namespace_path("net") +
        " sh -ec 'ip link set lo up; ip addr add 10.77.0.2/24 dev cable_there; ip link set cable_there up; "
        "ip route add 224.0.0.0/4 dev cable_there'");
  }
  ~Cable() { run("ip link del cable; ip route replace 224.0.0.0/4 dev lo"); }

  bool is_ready() const { return ready_; }
  // Command prefix for the second machine; nsenter replaces itself by the command.
  std::vector<std::string> remote_prefix() const {
    std::vector<std::string> words{"nsenter", "--net=" + namespace_path("net")};
    if (clock_) words.push_back("--time=" + namespace_path("time"));
    return words;
  }

 private:
  std::string pid_file() const { return folder_.path() / "number"; }
  std::string namespace_path(const std::string& kind) const { return "/proc/" + std::to_string(pid_) + "/ns/" + kind; }
  bool run(const std::string& commands) {
    const std::string name = "command" + std::to_string(++commands_);
    processes_.spawn(name, {"sh", "-c", "PATH=$PATH:/usr/sbin:/sbin; " + commands});
    return processes_.wait_for_exit(name, 20) == 0;
  }

  Folder folder_;
  Processes processes_;
  int commands_ = 0;
  bool ready_ = false, clock_ = false;
  pid_t pid_ = 0;
};

struct TwoMachines {
  Cable cable;
  std::optional<RunningCluster> running;
  sync::Queue<sync_report_t>* reports = nullptr;

  // Starts everything and waits until all modalities have rendered something. Returns false where the system allows no second machine.
  bool start() {
    if (!cable.is_ready()) {
      WARN("skipped: this system does not allow a second network namespace with a cable");
      return false;
    }
    running.emplace();
    reports = &monitor().bus().queue<sync_report_t>(channels::kSyncReport, 256);
    start_node("sync_node");
    start_remote("sync_node", "sync_node_there");
    for (const std::string& node : kNodes) start_node(node);
    const bool alive = monitor().wait_until(
        [&] {
          return running->all_running(kNodes) && monitor().hits() > 0 &&
                 std::all_of(kModalityNodes.begin(), kModalityNodes.end(), [&](const auto& n) { return monitor().rendered(n) > 0; });
        },
        kTimeout_s);
    UNSCOPED_INFO(running->log_text());
    REQUIRE(alive);
    return true;
  }
  ClusterMonitor& monitor() { return running->monitor; }
  // Starts a node on its machine.
  void start_node(const std::string& node) {
    if (std::find(kRemoteNodes.begin(), kRemoteNodes.end(), node) != kRemoteNodes.end()) return start_remote(node, node);
    std::vector<std::string> options{"--ttl", "1"};
    if (node == "sim_node") options.push_back(tapping_scene());
    running->processes.start(node, options);
  }

 private:
  void start_remote(const std::string& program, const std::string& name) {
    std::vector<std::string> command = cable.remote_prefix();
    command.insert(command.end(),
                   {(programs() / program).string(), "--name", name, "--run-id", std::to_string(RunningCluster::kRunId),
                    "--out", running->folder.path().string(), "--ttl", "1"});
    if (program == "audio_node") command.insert(command.end(), {"--audio-device", "virtual"});
    running->processes.spawn(name, command);
  }
};

}  // namespace tactus::cluster
