// Subscriber of the cluster tests: the newest health of each node, and some channels as they arrive.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/presented_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <vector>

#include "sync/bus/bus.h"

namespace tactus::cluster {

class ClusterMonitor {
 public:
  // Accepts only messages of this run: a replayed log contains nodes of the same names.
  explicit ClusterMonitor(std::int64_t run_id);

  // Receives messages until the condition holds; false when it does not hold within timeout_s seconds.
  bool wait_until(const std::function<bool()>& condition, double timeout_s);
  // Receives messages for the given time, s.
  void receive_for(double seconds);

  // The newest health of a node; null after 1.5 s without one.
  const node_health_t* health(const std::string& node) const;
  // The newest health that was ever received of a node, for its counters. Throws std::runtime_error when none was received.
  const node_health_t& newest_health(const std::string& node) const;
  bool in_state(const std::string& node, std::int8_t state) const;
  // Ticks and presented events of a node in its newest health message; 0: none was received.
  std::int64_t ticks(const std::string& node) const;
  std::int64_t rendered(const std::string& node) const;
  // Rejected messages, over all inputs of a node.
  std::int64_t malformed(const std::string& node) const;
  // Number of changes of a node's incarnation.
  std::int64_t rejoined(const std::string& node) const;

  const tool_state_t* tool_state() const { return tool_ ? &*tool_ : nullptr; }
  // N, of the newest TOOL_STATE; -1: none was received.
  double force_N() const;
  // Ids of the live contacts in the newest complete snapshots of both groups, and the incarnation of the simulation that sent them.
  std::set<std::int64_t> contact_ids() const;
  // Number of hits received so far.
  std::int64_t hits() const { return static_cast<std::int64_t>(hits_.size()); }

  // Events presented or dropped so far, by modality and event.
  const std::map<std::string, std::map<std::int64_t, presentation_t>>& presented() const { return presented_; }
  sync::Bus& bus() { return bus_; }

 private:
  struct NodeStatus {
    node_health_t health;
    sync::HostTime arrival;
    std::int64_t incarnations = 0;
  };
  struct Snapshot {
    std::int64_t incarnation = 0, sim_time_ns = -1;
    int pages = 0;
    std::map<int, std::vector<std::int64_t>> ids;  // by page
  };
  void drain();
  void on_message(const contact_frame_t& page);

  std::int64_t run_id_;
  sync::Bus bus_;
  sync::Queue<node_health_t>& health_queue_;
  sync::Queue<tool_state_t>& tool_queue_;
  sync::Queue<contact_frame_t>& contact_queue_;
  sync::Queue<contact_events_t>& event_queue_;
  sync::Queue<presented_t>& presented_queue_;
  std::map<std::string, NodeStatus> nodes_;
  std::optional<tool_state_t> tool_;
  Snapshot snapshots_[3];           // newest complete one of each group
  std::map<int, Snapshot> partial_;  // by group
  std::set<std::int64_t> hits_;
  std::map<std::string, std::map<std::int64_t, presentation_t>> presented_;
};

}  // namespace tactus::cluster
