// What a run was like, from its log alone: rates, losses, who presented what and when. Pure: fed with the events
// of one log after the other.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tactus/game_state_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/log_info_t.hpp>
#include <tactus/node_health_t.hpp>
#include <vector>

#include "sync/time/histogram.h"
#include "sync/log/log_reader.h"
#include "sync/presentation/presentation_matcher.h"
#include "sync/bus/sequence.h"
#include "sync/log/summary_clock.h"

namespace tactus::sync {

// What the caller knows better than the log.
struct SummaryOptions {
  std::optional<std::string> scene, git;
  std::optional<double> seconds;
  std::optional<std::int64_t> seed;
  std::vector<std::string> nodes;                // that must have been there to the end
  std::map<std::string, std::int64_t> restarts;  // as the supervisor counted them
  std::vector<std::string> warnings;             // what was missing where it ran, a sentence each
};

struct NodeSummary {
  double rate_Hz = 0;
  std::int64_t ticks = 0;
  std::int64_t missed_ticks = 0;
  std::int64_t stale_ticks = 0;
  Histogram tick, wake;
  std::map<std::string, Histogram> input_age;  // by channel, ten times a second
  std::vector<std::int64_t> quality;  // health reports at each step of its ladder, 0: full; empty: it has none
  std::int64_t restarts = 0;
  // What the node said last of its priority and its troubles, while there was a simulation: a run ends without one.
  std::string scheduling;
  bool alive_at_end = false;
};

struct ChannelSummary {
  std::int64_t messages = 0;
  std::int64_t bytes = 0;  // of the messages, without the headers of the log and of the network
  std::int64_t gaps = 0;   // missing in the numbering of a sender
  std::int64_t bad = 0;    // could not be decoded
};

class RunSummary {
 public:
  // A node is alive at the end when it reported health within so long of it.
  static constexpr Nanoseconds kAliveWithin{3'000'000'000};
  // So long without an event, and then the numbering of a sender goes on farther up: the recorder was stopped.
  static constexpr Nanoseconds kHole{1'000'000'000};
  // What the kernel kept for it meanwhile comes first.
  static constexpr Nanoseconds kHoleShowsWithin{2'000'000'000};

  explicit RunSummary(SummaryOptions options) : options_(std::move(options)) {}

  void add(const LogEvent& event);
  // After each log: what its end leaves open is settled.
  void end_of_log(std::int64_t damaged_regions);

  std::string scene() const { return options_.scene.value_or(info_ ? info_->scene : ""); }
  std::string git() const { return options_.git.value_or(info_ ? info_->git : ""); }
  std::int64_t seed() const { return options_.seed.value_or(info_ ? info_->seed : 0); }
  // As asked for; else as long as was recorded.
  double seconds() const;
  double recorded_seconds() const;
  // Simulated seconds per second of the host while there was a simulation; 0: there was none.
  double realtime_factor() const;
  std::map<std::string, NodeSummary> nodes() const;
  // Senses that no node ever reported for.
  std::vector<std::string> absent() const;
  const std::vector<std::string>& warnings() const { return options_.warnings; }
  const PresentationMatcher& matcher() const { return matcher_; }
  std::map<std::string, ChannelSummary> channels() const;
  std::int64_t damaged_regions() const { return damaged_regions_; }
  // How the game of the scene stood last; nothing: it has none.
  const std::optional<game_state_t>& game() const { return game_; }
  // For so long in all nothing was recorded, though something was sent: nobody knows who was dead or stalled then.
  double holes_seconds() const { return to_seconds(holes_); }

  // Why the run was not a success, in one sentence; empty: it was.
  std::string failure() const;

 private:
  // One incarnation of a node: its first health at its present rate, and its last; its last note that the simulation
  // outlived.
  struct Life {
    node_health_t first, last;
    std::string note;
    HostTime last_heard{};
  };
  static constexpr std::size_t kMaxInputs = 64;  // of one node
  struct Channel {
    ChannelSummary summary;
    SequenceTracker sequence;
  };
  // Simulated time against host time of one incarnation of the simulation.
  struct Course {
    std::int64_t first_sim_ns, first_host_ns, last_sim_ns, last_host_ns;
  };

  void observe(const log_info_t&);
  void observe(const node_health_t&, HostTime now);
  void observe_course(const header_t&);
  void observe_silence(HostTime now);
  void observe_gap();

  SummaryOptions options_;
  std::optional<log_info_t> info_;
  bool time_known_ = false;  // of the present log
  std::int64_t realtime_offset_ns_ = 0;
  std::int64_t live_from_ns_ = 0;
  SummaryClock clock_;
  // Run 0: that of the first that speaks.
  std::unique_ptr<ClockMaps> maps_ = std::make_unique<ClockMaps>(0);
  PresentationMatcher matcher_{OwnClock(0, 0, maps_.get())};
  std::map<std::string, std::map<std::int64_t, Life>> lives_;  // by node, by incarnation
  std::map<std::string, std::map<std::string, Histogram>> input_age_;  // by node, by channel
  std::map<std::string, std::vector<std::int64_t>> quality_;           // by node
  std::map<std::string, Channel, std::less<>> channels_;
  std::map<std::int64_t, Course> courses_;
  std::optional<game_state_t> game_;
  std::optional<HostTime> begin_;
  HostTime now_{};
  Nanoseconds recorded_{0};
  Nanoseconds silence_{0};  // the last one that may be a hole
  HostTime silence_end_{};
  Nanoseconds holes_{0};
  std::int64_t damaged_regions_ = 0;
};

// summary.json.
std::string to_json(const RunSummary&);
// The same for people.
std::string to_text(const RunSummary&);

}  // namespace tactus::sync
