// The parts that every process of the cluster has: options, identity, priority, the bus, a paced loop, health. The main
// function of a node is then these few lines:
//
//   sync::Node node(descriptor, options);
//   while (node.running()) {
//     const sync::HostTime now = node.wait();   // sleeps until the tick, drains the bus
//     ...                                       // pure work
//     node.bus().publish(channel, message);
//   }
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <tactus/node_health_t.hpp>
#include <tactus/tag_request_t.hpp>
#include <utility>

#include "sync/bus/bus.h"
#include "sync/node/node_descriptor.h"
#include "sync/node/node_options.h"
#include "sync/time/histogram.h"
#include "sync/clocks/pacing.h"
#include "sync/time/phases.h"
#include "sync/node/realtime.h"
#include "sync/node/tags.h"

namespace tactus::sync {

// Reads the files that the options of every node name, as the constructor of Node does. Throws std::runtime_error with one sentence.
void check_node_files(const NodeOptions& options);

// Throws std::runtime_error with one sentence when no file can be created there: its folder is missing, or not writable. For the
// check of an output file that is created later. option: named in the sentence.
void check_folder_of(const std::string& path, const std::string& option);

class Node {
 public:
  // Sets its priority, opens the bus, prints one line. Throws std::runtime_error with one sentence.
  Node(NodeDescriptor descriptor, NodeOptions options);
  ~Node();

  // False after SIGTERM or SIGINT.
  bool running() const;

  // Ends the previous tick, reports health when due, sleeps until the next tick, drains the bus. Returns the clock.
  HostTime wait();
  // Drains the bus within a tick, without waiting. Returns the clock.
  HostTime poll();
  // Like wait(), for an event-driven process: wakes when a message arrives, after one period at the latest.
  HostTime wait_for_event();

  // Starts a new incarnation; receivers see a restart. Health counts from zero.
  void begin_incarnation();

  Bus& bus() { return bus_; }
  // Tagged variables of this process; the time of each phase of its tick is among them.
  Tags& tags() { return tags_; }
  const NodeOptions& options() const { return options_; }
  const NodeDescriptor& descriptor() const { return descriptor_; }
  void set_rate(double rate_Hz);
  // Re-phases the loop to an external clock: the next tick is at next_tick; the skipped ticks before it count as missed.
  void align(HostTime next_tick, std::int64_t skipped = 0) { loop_.align(next_tick, skipped); }
  // Ticks done and missed so far: their sum numbers the periods of the loop.
  const Deadlines& deadlines() const { return loop_.deadlines(); }

  // Reports health when it is due, and does nothing else. For work that takes many ticks: call it between the parts.
  void heartbeat() {
    if (const HostTime now = host_now(); now >= next_report_) report(now);
  }

  // State and note of the next health report.
  void set_state(std::int8_t state, std::string status_text = "");
  void set_tool(int tool) { health_.tool = tool; }
  void count_rendered(std::int64_t events) { health_.contacts_rendered += events; }
  // Step of the node's quality ladder (0: full quality), and the number of steps.
  void set_quality(int step, int steps) {
    health_.quality = static_cast<std::int8_t>(step);
    health_.qualities = static_cast<std::int8_t>(steps);
  }
  void set_profile(std::int64_t hash) { health_.profile = hash; }
  // The measured effect of the profile (sync/degradation/measured_effect.h): the end of the text of the next health reports,
  // after "profile effect: "; empty: none.
  void set_profile_effect(std::string text) { profile_effect_ = std::move(text); }
  void set_realtime_factor(double factor) { health_.realtime_factor = factor; }
  // For nodes that tick elsewhere (the audio callback): totals that replace those of the loop.
  void override_ticks(std::int64_t ticks, std::int64_t missed, double rate_Hz);

 private:
  void tag_work();
  // A tick of the loop ends, and the next one begins.
  void end_tick(HostTime now);
  void begin_tick(HostTime now);
  void serve_tags(HostTime now);
  void report(HostTime now);
  node_health_t health_message(HostTime now);

  NodeDescriptor descriptor_;
  NodeOptions options_;
  std::string scheduling_;
  Bus bus_;
  Loop loop_;
  PriorityKeeper priority_;
  Tags tags_;
  Queue<tag_request_t> tag_requests_;
  Phases phases_{host_now};
  double work_us_ = 0;
  Histogram tick_, wake_;
  node_health_t health_{};
  std::string status_text_, profile_effect_;
  HostTime tick_begin_{};
  HostTime next_report_{};
  HostTime rate_since_{};
  std::int64_t ticks_at_rate_since_ = 0;
  std::int64_t ticks_before_ = 0, missed_before_ = 0;  // of earlier incarnations
  std::int64_t event_ticks_ = 0;
  bool overridden_ = false;
  int reports_ = 0;
};

}  // namespace tactus::sync
