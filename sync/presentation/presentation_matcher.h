// Who owed which contact event a presentation, and what became of it. The heart of sync_node and of the summary.
// Pure.
//
// A node declares in NODE_HEALTH what it owes. An event is settled 1 s after its time (half a second after it was
// first heard of, if that is later; so much later as a sense is to present it late on purpose): nothing waits for
// a dead sense. Every debt has exactly one outcome:
//   presented           the node reported so, also late or inaudible
//   dropped_by_profile  the node reported so: its degradation asked for it
//   dropped_late        the node reported so
//   stalled             no report, and its health had a gap of more than 0.3 s within 0.1 s after the event
//   dead                no report, and the node was gone, replaced, not running again, or without output within
//   0.1 s
//                       after the event; or the simulation died before it could repeat the event for its 50 ms
//   lost                no report from a node that was there
// While a simulation of this run is there, the events of other runs, as of a log that is played beside it, are
// owed by nobody. A node that never ran owes nothing. A report of what is not owed is no outcome, but counts for
// the asynchrony.
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
#include <tactus/sync_report_t.hpp>
#include <utility>
#include <vector>

#include "sync/playout/follower.h"
#include "sync/presentation/presentation_matcher_life.h"
#include "sync/presentation/presentation_matcher_soa.h"
#include "sync/clocks/sender_clock.h"

namespace tactus::sync {

// Debts of one modality by outcome.
struct DebtTally {
  std::int64_t owed = 0;
  std::int64_t presented = 0;
  std::int64_t late = 0;  // of those presented
  std::int64_t lost = 0;
  std::int64_t stalled = 0;
  std::int64_t dead = 0;
  std::int64_t dropped_by_profile = 0;
  std::int64_t dropped_late = 0;
};

// True when sense a is named before sense b: the known ones from the quickest to the slowest, then all others by
// name.
bool named_before(const std::string& a, const std::string& b);

class PresentationMatcher {
 public:
  struct Need {
    std::int64_t event_id;
    std::string modality;
    Nanoseconds needed;
  };
  static constexpr Nanoseconds kSettleAfter{1'000'000'000};
  // A node that ends or stalls within this of an event may have had no time to report it: the output is at most
  // some 50 ms behind the event, and health comes every 100 ms.
  static constexpr Nanoseconds kReportsWithin{100'000'000};
  // Events are repeated for so long.
  static constexpr Nanoseconds kRepeated{50'000'000};
  // The processes of a run end one after the other: an event so short before the simulation's last health belongs
  // to the end.
  static constexpr Nanoseconds kEndsWithin{300'000'000};
  // Repetitions and late reports are recognised for so long after an event was settled.
  static constexpr Nanoseconds kRemember{5'000'000'000};
  static constexpr std::size_t kMaxEvents = 1 << 16;
  // Those that nobody takes are forgotten.
  static constexpr std::size_t kMaxNeeds = 4096;
  // Nodes, senses, and simulations of other runs.
  static constexpr std::size_t kMaxSenses = 64;
  // Each keeps a histogram of 160 kB.
  static constexpr std::size_t kMaxPairs = 256;

  // All times are put on this clock. Health and reports of another run are ignored and counted. Run 0: run and
  // clock of the first health that arrives.
  explicit PresentationMatcher(OwnClock own) : own_(own) {}

  void observe(const contact_events_t&, HostTime arrival);
  void observe(const node_health_t&, HostTime arrival);
  void observe(const presented_t&, HostTime arrival);
  // How late a sense presents on purpose, all events or single ones: they are settled so much later.
  void observe(const playout_t&, HostTime arrival);
  void observe(const degraded_t&, HostTime arrival);
  // How long senses needed, from an event to its earliest possible presentation with nothing degraded, by what was
  // observed since the last call.
  std::vector<Need> take_needs() { return std::exchange(needs_, {}); }
  // Settles what is due.
  void advance(HostTime now);
  // Nothing more will come: settles all that can be decided, and drops the debts that cannot: of a node that was
  // not heard of again until now.
  void finish(HostTime now);

  // The senses whose nodes were heard of, and whether the others wait for them.
  std::map<std::string, bool> senses() const;
  std::int64_t begins() const { return begins_; }
  std::int64_t hits() const { return hits_; }
  std::int64_t ends() const { return ends_; }
  const std::map<std::string, DebtTally>& modalities() const { return tallies_; }
  // soa(a, b) = t_present(b) - t_present(a), a named before b. What answers a begin with a push at once, whatever
  // the policy, is apart from what answers a hit when it is due: "haptic_push" beside "haptic".
  const std::map<std::pair<std::string, std::string>, SoaHistogram>& pairs() const { return pairs_; }

  // Reports of a time on a clock that nobody has mapped: they count as presented, but not for the asynchrony, for
  // nobody knows how uncertain it would be.
  std::int64_t unmapped_reports() const { return unmapped_reports_; }
  // Reports of events that were settled already, of events never heard of, and messages of other runs.
  std::int64_t late_reports() const { return late_reports_; }
  std::int64_t unknown_reports() const { return unknown_reports_; }
  std::int64_t foreign() const { return foreign_; }
  // Events, nodes, senses, pairs and simulations of other runs that found no room.
  std::int64_t overflow() const { return overflow_; }

 private:
  struct Renderer {
    std::string modality;  // empty: renders nothing
    std::int32_t owes = 0;
    std::int32_t tool = -1;
    NodeLife life;
    std::int64_t dead_unless_it_returns = 0;
  };
  // A debt called dead because both the node and the simulation fell silent: if neither speaks again, the run had
  // ended.
  struct LastDebt {
    std::int32_t source, simulation;
    std::string modality;
  };
  struct Report {
    std::int32_t source = 0;
    std::string modality;
    std::int8_t part = 0;
    std::int8_t outcome = 0;
    std::int64_t presented_ns = -1;  // on our clock; -1: not, or not known
    Nanoseconds uncertainty{0};      // half width
  };
  struct Event {
    bool known = false;  // false: so far only reports of it came
    bool settled = false;
    std::int8_t kind = 0;
    std::int32_t tool = -1;
    std::int32_t source = 0;  // of the simulation
    std::int64_t incarnation = 0;
    HostTime time{};
    std::vector<Report> reports;
    std::map<std::string, Nanoseconds> held;  // by profiles, by modality
  };

  Event* find_or_add(std::int64_t id, HostTime arrival);
  bool owes(const Renderer&, const Event&) const;
  // So much later than at once is this sense to present the event.
  Nanoseconds on_purpose(const Event&, const std::string& modality) const;
  Nanoseconds longest_on_purpose(const Event&) const;
  SenderClock& clock_of(const header_t&, HostTime arrival);
  void settle(Event&, HostTime now, bool last);
  void settle_debt(Renderer&, std::int32_t source, const Event&, HostTime now, bool last);
  void count_asynchrony(const Event&);

  OwnClock own_;
  std::map<std::int32_t, Renderer> renderers_;  // by source
  std::map<std::int32_t, SenderClock> clocks_;  // by source
  std::map<std::int64_t, Event> events_;
  std::multimap<HostTime, std::int64_t> due_;
  std::multimap<HostTime, std::int64_t> forget_;
  std::vector<LastDebt> last_debts_;
  std::vector<Need> needs_;
  std::map<std::string, PlayoutFollower> playout_;  // by modality: each follows as its sense does
  Nanoseconds turn_{0};                             // of a lock-step
  // Simulations of this run that have told of events, and when one was last heard of.
  std::set<std::int32_t> simulations_;
  std::optional<HostTime> simulation_heard_;
  std::map<std::string, DebtTally> tallies_;
  std::map<std::pair<std::string, std::string>, SoaHistogram> pairs_;
  std::int64_t begins_ = 0, hits_ = 0, ends_ = 0;
  std::int64_t late_reports_ = 0, unknown_reports_ = 0, foreign_ = 0, overflow_ = 0, unmapped_reports_ = 0;
};

}  // namespace tactus::sync
