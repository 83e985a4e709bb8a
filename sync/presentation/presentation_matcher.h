// Matches contact events to presentation reports and classifies the outcome. Used by sync_node and by the summary. Pure.
//
// A node declares in NODE_HEALTH the events that it must present. An event is settled 1 s after its time, or half a second
// after its first arrival, if that is later. An intended delay of a modality adds to that. A dead modality holds up nothing.
// Every expected presentation has exactly one outcome:
//   presented           the node reported so, also late or inaudible
//   dropped_by_profile  the node reported so: its degradation required it
//   dropped_late        the node reported so
//   stalled             no report, and its health had a gap of more than 0.3 s within 0.1 s after the event
//   dead                no report, and within 0.1 s after the event the node was gone, replaced, not running again, or
//                       without output; or the simulation died before it could repeat the event for its 50 ms, or was
//                       replaced before the event was due
//   lost                no report from a running node
// While a simulation of this run publishes, no presentation is expected of events of other runs, such as those of a log that
// is played at the same time. None is expected of a node that never ran. A report that was not expected is not an outcome, but
// counts for the asynchrony.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tactus/contact_events_t.hpp>
#include <tactus/degraded_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/playout_t.hpp>
#include <tactus/presented_t.hpp>
#include <utility>
#include <vector>

#include "sync/playout/follower.h"
#include "sync/presentation/node_activity.h"
#include "sync/presentation/presentation_matcher_soa.h"
#include "sync/clocks/sender_clock.h"

namespace tactus::sync {

// Expected presentations of one modality by outcome.
struct OutcomeCounts {
  std::int64_t expected = 0;
  std::int64_t presented = 0;
  std::int64_t late = 0;  // of those presented
  std::int64_t lost = 0;
  std::int64_t stalled = 0;
  std::int64_t dead = 0;
  std::int64_t dropped_by_profile = 0;
  std::int64_t dropped_late = 0;
};

// Order of modalities in names of pairs: returns true when a precedes b. The known modalities come first, from the quickest
// to the slowest; then all others by name.
bool named_before(const std::string& a, const std::string& b);

class PresentationMatcher {
 public:
  struct Need {
    std::int64_t event_id;
    std::string modality;
    Nanoseconds needed;
  };
  static constexpr Nanoseconds kSettleAfter{1'000'000'000};
  // A node that ends or stalls within this time of an event may have been unable to report it: the output follows the event
  // within about 50 ms, and health is published every 100 ms.
  static constexpr Nanoseconds kReportsWithin{100'000'000};
  // Time during which the simulation repeats an event.
  static constexpr Nanoseconds kRepeated{50'000'000};
  // The processes of a run end one after the other: an event within this time before the simulation's last health belongs to
  // the end of the run.
  static constexpr Nanoseconds kEndsWithin{300'000'000};
  // Time after the settlement of an event during which repetitions and late reports are recognised.
  static constexpr Nanoseconds kRemember{5'000'000'000};
  static constexpr std::size_t kMaxEvents = 1 << 16;
  // Older needs that were not taken are discarded.
  static constexpr std::size_t kMaxNeeds = 4096;
  // Limit of nodes, of modalities, and of simulations of other runs.
  static constexpr std::size_t kMaxModalities = 64;
  // Each keeps a histogram, usually of a few kB.
  static constexpr std::size_t kMaxPairs = 256;

  // All times are converted to this clock. Health and reports of another run are ignored. Run 0: the run and
  // clock of the first health message.
  explicit PresentationMatcher(OwnClock own) : own_(own) {}

  void observe(const contact_events_t&, HostTime arrival);
  void observe(const node_health_t&, HostTime arrival);
  void observe(const presented_t&, HostTime arrival);
  // Intended delays of a modality, for all events or single ones: their settlement is later by that delay.
  void observe(const playout_t&, HostTime arrival);
  void observe(const degraded_t&, HostTime arrival);
  // The needs since the last call: the time from an event to the earliest possible presentation by a modality, without
  // degradation.
  std::vector<Need> take_needs() { return std::exchange(needs_, {}); }
  // Settles the due events.
  void advance(HostTime now);
  // Ends the input: settles all decidable events, and drops the expected presentations of nodes that did not publish again.
  void finish(HostTime now);

  // The modalities whose nodes have published, and whether the others wait for them.
  std::map<std::string, bool> running_modalities() const;
  std::int64_t begins() const { return begins_; }
  std::int64_t hits() const { return hits_; }
  std::int64_t ends() const { return ends_; }
  const std::map<std::string, OutcomeCounts>& modalities() const { return tallies_; }
  // soa(a, b) = t_present(b) - t_present(a), with a named before b. The push that answers a begin immediately, under every
  // policy, is separate from the vibration that answers a hit when it is due: "haptic_push" in addition to "haptic".
  const std::map<std::pair<std::string, std::string>, SoaHistogram>& pairs() const { return pairs_; }

  // Events, nodes, modalities, pairs and simulations of other runs beyond the limits.
  std::int64_t overflow() const { return overflow_; }

 private:
  struct Renderer {
    std::string modality;  // empty: renders nothing
    std::int32_t expected_events = 0;
    std::int32_t tool = -1;
    NodeActivity activity;
    std::int64_t provisionally_dead = 0;
  };
  // An expected presentation that counts as dead because both the node and the simulation stopped publishing: if neither
  // publishes again, the run had ended.
  struct FinalExpectation {
    std::int32_t source, simulation;
    std::string modality;
  };
  struct Report {
    std::int32_t source = 0;
    std::string modality;
    std::int8_t part = 0;
    std::int8_t outcome = 0;
    std::int64_t presented_ns = -1;  // on our clock; -1: not presented, or unknown
    Nanoseconds uncertainty{0};      // half width
  };
  struct Event {
    bool known = false;  // false: only reports of it have arrived
    bool settled = false;
    std::int8_t kind = 0;
    std::int32_t tool = -1;
    std::int32_t source = 0;  // of the simulation
    std::int64_t incarnation = 0;
    HostTime time{};
    std::vector<Report> reports;
    std::map<std::string, Nanoseconds> held;  // delays by profiles, by modality
  };

  Event* find_or_add(std::int64_t id, HostTime arrival);
  bool expects(const Renderer&, const Event&) const;
  // The intended delay of this modality for the event: of the playout plan or, if longer, the one that its newest report
  // shows, since a modality also has a delay of its own; and the delay of its profile.
  Nanoseconds intended_delay(const Event&, const std::string& modality) const;
  Nanoseconds max_intended_delay(const Event&) const;
  SenderClock& clock_of(const header_t&, HostTime arrival);
  void settle(Event&, HostTime now, bool last);
  void settle_expected(Renderer&, std::int32_t source, const Event&, HostTime now, bool last);
  void count_asynchrony(const Event&);

  OwnClock own_;
  std::map<std::int32_t, Renderer> renderers_;  // by source
  std::map<std::int32_t, SenderClock> clocks_;  // by source
  std::map<std::int64_t, Event> events_;
  std::multimap<HostTime, std::int64_t> due_;
  std::multimap<HostTime, std::int64_t> forget_;
  std::vector<FinalExpectation> final_expectations_;
  std::vector<Need> needs_;
  std::map<std::string, PlayoutFollower> playout_;  // by modality: each follows as its node does
  std::map<std::string, Nanoseconds> reported_delay_;  // by modality: of its newest scheduled presentation, without its profile
  Nanoseconds lockstep_period_{0};                             // period of a lock-step
  // Simulations of this run that have published events, and the newest arrival from one.
  std::set<std::int32_t> simulations_;
  std::optional<HostTime> simulation_last_seen_;
  std::map<std::string, OutcomeCounts> tallies_;
  std::map<std::pair<std::string, std::string>, SoaHistogram> pairs_;
  std::int64_t begins_ = 0, hits_ = 0, ends_ = 0;
  std::int64_t overflow_ = 0;
};

}  // namespace tactus::sync
