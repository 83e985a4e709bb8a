// The summary of a run, from its log alone: rates, losses, presentations and their times. Pure: it receives the events of one
// log after the other.
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
#include "sync/tools/summary/run_warnings.h"

namespace tactus::sync {

// Values of the caller that take precedence over those of the log.
struct SummaryOptions {
  std::optional<std::string> scene, git;
  std::optional<double> seconds;
  std::optional<std::int64_t> seed;
  std::vector<std::string> nodes;                // that must be alive at the end
  std::map<std::string, std::int64_t> restarts;  // as counted by the supervisor
  std::vector<std::string> warnings;             // resources missing on the host of the run, a sentence each
};

struct NodeSummary {
  double rate_Hz = 0;
  std::int64_t ticks = 0;
  std::int64_t missed_ticks = 0;
  std::vector<std::int64_t> missed_by_second;  // of them in each of the first seconds of the world; empty: not known
  std::int64_t stale_ticks = 0;
  Histogram tick, wake;
  std::map<std::string, Histogram> input_age;  // by channel, ten times a second
  std::vector<std::int64_t> quality;  // health reports at each step of its quality ladder, 0: full; empty: it has no ladder
  std::int64_t restarts = 0;
  // The node's last note on its priority and its troubles while a simulation was present: a run ends without one.
  std::string scheduling;
  std::string profile_effect;  // measured by the node; empty: no profile degraded its modality
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
  // A node counts as alive at the end when it reported health within this time of it.
  static constexpr Nanoseconds kAliveWithin{3'000'000'000};
  // After a gap of this length with a jump in the numbering of a sender, the recorder was stopped.
  static constexpr Nanoseconds kHole{1'000'000'000};
  // Time for the messages that the kernel had buffered meanwhile, which come first.
  static constexpr Nanoseconds kHoleDetectedWithin{2'000'000'000};

  explicit RunSummary(SummaryOptions options) : options_(std::move(options)) {}

  void add(const LogEvent& event);
  // Call it after each log: settles the outcomes that its end leaves open.
  void end_of_log(std::int64_t damaged_regions);

  std::string scene() const { return options_.scene.value_or(info_ ? info_->scene : ""); }
  std::string git() const { return options_.git.value_or(info_ ? info_->git : ""); }
  std::int64_t seed() const { return options_.seed.value_or(info_ ? info_->seed : 0); }
  // The requested duration; by default the recorded one.
  double seconds() const;
  double recorded_seconds() const;
  // Simulated seconds per second of the host while a simulation was present; 0: there was none.
  double realtime_factor() const;
  std::map<std::string, NodeSummary> nodes() const;
  // Modalities without a report by any node.
  std::vector<std::string> absent() const;
  // Messages that could not be decoded, a sentence for each channel.
  std::vector<std::string> damage() const;
  // Of the caller, then of the run itself (run_warnings.h), then damage().
  std::vector<std::string> warnings() const;
  const PresentationMatcher& matcher() const { return matcher_; }
  std::map<std::string, ChannelSummary> channels() const;
  std::int64_t damaged_regions() const { return damaged_regions_; }
  // The last state of the scene's game; nullopt: it has none.
  const std::optional<game_state_t>& game() const { return game_; }
  // Total time without a record although messages were sent; dead and stalled nodes cannot be detected within it.
  double holes_seconds() const { return to_seconds(holes_); }

  // The reason why the run was not a success, in one sentence; empty: it was.
  std::string failure() const;

 private:
  // One incarnation of a node: its first health at its present rate, its last health, and its last note while a simulation
  // was present.
  struct Incarnation {
    node_health_t first, last;
    std::string status_text;
    HostTime last_received{};
  };
  static constexpr std::size_t kMaxInputs = 64;  // of one node
  struct Channel {
    ChannelSummary summary;
    SequenceTracker sequence;
  };
  // Simulated time against host time of one incarnation of the simulation.
  struct SimProgress {
    std::int64_t first_sim_ns, first_host_ns, last_sim_ns, last_host_ns;
  };

  void observe(const log_info_t&);
  void observe(const node_health_t&, HostTime now);
  void observe_sim_progress(const header_t&);
  void observe_silence(HostTime now);
  void observe_gap();

  SummaryOptions options_;
  std::optional<log_info_t> info_;
  bool time_known_ = false;  // for the current log
  std::int64_t realtime_offset_ns_ = 0;
  std::int64_t live_from_ns_ = 0;
  SummaryClock clock_;
  // Run 0: the run of the first message.
  std::unique_ptr<ClockMaps> maps_ = std::make_unique<ClockMaps>(0);
  PresentationMatcher matcher_{OwnClock(0, 0, maps_.get())};
  std::map<std::string, std::map<std::int64_t, Incarnation>> incarnations_;  // by node, by incarnation
  std::map<std::string, std::map<std::string, Histogram>> input_age_;  // by node, by channel
  std::map<std::string, std::vector<std::int64_t>> quality_;           // by node
  std::map<std::string, Channel, std::less<>> channels_;
  std::map<std::int64_t, SimProgress> sim_progress_;
  std::optional<game_state_t> game_;
  RunWarnings warnings_;
  std::optional<HostTime> begin_;
  HostTime now_{};
  Nanoseconds recorded_{0};
  Nanoseconds silence_{0};  // the last gap, which may be a hole
  HostTime silence_end_{};
  Nanoseconds holes_{0};
  std::int64_t damaged_regions_ = 0;
};

// summary.json.
std::string to_json(const RunSummary&);
// The same as text.
std::string to_text(const RunSummary&);

}  // namespace tactus::sync
