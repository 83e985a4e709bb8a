// A whole cluster with the small scene, and a subscriber to its bus.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <tactus/input_health_t.hpp>
#include <tactus/node_health_t.hpp>

#include "lcmtypes/channels.h"
#include "tests/cluster/support/cluster_monitor.h"
#include "tests/cluster/support/processes.h"
#include "tests/cluster/support/rate_factor.h"

namespace tactus::cluster {

// Long enough for a loaded machine: the tests assert liveness, not speed.
constexpr double kTimeout_s = 40;

struct RunningCluster {
  static constexpr std::int64_t kRunId = 4711;

  Folder folder;
  Processes processes{folder.path(), kRunId};
  ClusterMonitor monitor{kRunId};

  bool state(const std::string& node, std::int8_t wanted) const { return monitor.in_state(node, wanted); }
  bool is_running(const std::string& node) const { return state(node, node_health_t::RUNNING); }
  bool all_running(const std::vector<std::string>& nodes) const {
    return std::all_of(nodes.begin(), nodes.end(), [&](const auto& n) { return is_running(n); });
  }
  // Starts everything and waits until all modalities have rendered something.
  void start() {
    processes.start_all(tapping_scene());
    const bool alive = monitor.wait_until([&] { return all_running(kNodes) && monitor.hits() > 0; }, kTimeout_s);
    UNSCOPED_INFO(log_text());
    REQUIRE(alive);
  }
  // Ticks per second over a while, by node.
  std::map<std::string, double> rates(double seconds) {
    std::map<std::string, std::pair<std::int64_t, std::int64_t>> before;
    for (const std::string& n : kNodes)
      if (const node_health_t* h = monitor.health(n)) before[n] = {h->ticks, h->header.publish_time_ns};
    monitor.receive_for(seconds);
    std::map<std::string, double> out;
    for (const auto& [n, b] : before) {
      const node_health_t* h = monitor.health(n);
      const double span_s = h ? static_cast<double>(h->header.publish_time_ns - b.second) * 1e-9 : 0;
      out[n] = span_s > 0 ? static_cast<double>(h->ticks - b.first) / span_s : 0;
    }
    return out;
  }
  // Checks that rates hold within rate_factor(), in the best of three spans: other work on the machine comes and goes, but a node that is
  // blocked, or runs too fast, is so in all of them.
  void check_rates_hold(const std::map<std::string, double>& before, double seconds,
                        const std::string& except = "") {
    std::map<std::string, double> left = before;
    left.erase(except);
    std::map<std::string, double> now;
    for (int span = 0; span < 3 && !left.empty(); ++span) {
      now = rates(seconds);
      std::erase_if(left, [&](const auto& b) {
        const auto at = now.find(b.first);
        const double factor = rate_factor(b.first);
        return at != now.end() && at->second > b.second / factor && at->second < b.second * factor;
      });
    }
    for (const auto& [node, rate] : left)
      FAIL_CHECK(node << ": " << rate << " Hz before, " << now[node] << " Hz in the last of three spans");
  }
  // True when the newest state and events that a node has received are less than half a second old.
  bool receives_the_present(const std::string& node) const {
    const node_health_t* h = monitor.health(node);
    return h && std::all_of(h->inputs.begin(), h->inputs.end(), [](const input_health_t& in) {
             const bool timed = in.channel == channels::kWorldState || in.channel == channels::kContactEvents;
             return !timed || in.age_ns < 500'000'000;
           });
  }
  // The last output of every process, for the report of a failure.
  std::string log_text() const {
    std::string all;
    for (const char* n : {"sim_node", "haptic_node", "audio_node", "visual_node", "thermal_node", "sync_node"}) {
      const node_health_t* h = monitor.health(n);
      all += std::string(n) + (h ? " state " + std::to_string(h->state) + " (" + h->status_text + ")" : " silent") +
             ": " + processes.output(n) + "\n";
    }
    return all;
  }
};

}  // namespace tactus::cluster
