// The contact events of a renderer: the only receiver of CONTACT_EVENTS. It applies the operators of the profile, drops
// repetitions, follows the clock of the simulation, and stores each event until the renderer takes it. Pure: time and messages
// are arguments.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/sim_clock_t.hpp>
#include <utility>
#include <vector>

#include "sync/bus/recent_map.h"
#include "sync/clocks/sim_clock_tracker.h"
#include "sync/degradation/decision_record.h"
#include "sync/degradation/operator_chain.h"
#include "sync/time/time.h"

namespace tactus::sync {

// A contact between its begin and end events, as far as they were released.
struct ContactSpan {
  std::optional<contact_event_t> begin;
  std::optional<SimTime> end;
};

class EventInbox {
 public:
  static constexpr std::size_t kMaxPending = 4096;
  // Events held by a profile: 1,000 events per second for its longest delay, one minute.
  static constexpr std::size_t kMaxHeld = 1 << 16;
  // Repetitions end 50 ms after an event; 8192 ids are 80 ms of 100,000 events a second.
  static constexpr std::size_t kRemembered = 8192;
  static constexpr std::size_t kMaxDropped = 4096;

  // own: times on another clock are converted by its map; times of another run by arrival.
  explicit EventInbox(OwnClock own) : clock_(own) {}

  // A message from the bus. The profile decides once for each event id, at its first arrival; repetitions change nothing.
  // decisions: list to which the decisions are appended; null: none.
  void push(const contact_events_t&, HostTime arrival, OperatorChain&, Decisions* decisions);
  // The same without a profile; releases the events immediately.
  void push(const contact_events_t& m, HostTime arrival) {
    OperatorChain none;
    push(m, arrival, none, nullptr);
    release(arrival);
  }
  // Releases the events that the profile holds until now. Call it after the messages of a tick.
  void release(HostTime now);
  // A message of another stream of the same simulation. False: it is of a replaced simulation and must be ignored.
  bool follow(const header_t& header, const sim_clock_t& clock, HostTime arrival);

  // Released events before `until` that were not returned before, in order of time. A late event is returned at the next call.
  std::vector<contact_event_t> take(SimTime until);
  // The same for one event, for a renderer that has no time for all of them in a tick. front: null when there is none.
  const contact_event_t* front(SimTime until) const;
  void pop_front();

  // Map between simulated time and this host's clock, from the newest message. nullopt before the first.
  std::optional<TimeMap> map(HostTime now) const { return clock_.map(now); }
  SimTime latest_plausible() const { return clock_.latest_plausible(); }
  // The released begin and end of a contact; null: neither was received.
  const ContactSpan* span_of(std::int64_t contact_id) const { return spans_.find(contact_id); }
  const RecentMap<std::int64_t, ContactSpan>& spans() const { return spans_; }

  // The arrival of the first message with an event, also of an event that the profile lost on the wire; nullopt: it has not
  // arrived, or is forgotten.
  std::optional<HostTime> arrival_of(std::int64_t event_id) const;
  // Change of the instant of its presentation by the profile, which its time contains already: Decision::shift.
  Nanoseconds shift_of(std::int64_t event_id) const;
  // Calls use(event id, first arrival), newest event first, until it returns false.
  template <class Use>
  void each_newest_first(Use use) const {
    memory_.each_newest_first([&](std::int64_t id, const Known& known) { return use(id, known.arrival); });
  }
  // Events that the profile dropped since the last call; a modality that must present them reports them as dropped.
  std::vector<contact_event_t> take_dropped() { return std::exchange(dropped_, {}); }

  // Changes whenever the simulation starts again, which ends all contacts. 0: nothing was received.
  std::int64_t epoch() const { return epoch_; }
  std::int64_t duplicates() const { return duplicates_; }
  // Events more than 1 s ahead of the time of their simulation.
  std::int64_t refused() const { return refused_; }
  // Dropped events: when too many are pending or held, the latest are dropped.
  std::int64_t overflow() const { return overflow_; }

 private:
  struct Known {
    HostTime arrival{};
    bool decided = false;  // in this incarnation of the simulation
    Nanoseconds shift{0};
  };
  struct HeldEvent {
    contact_event_t event;
    std::int64_t incarnation;
  };

  bool decide_now(std::int64_t id);
  void hold(const contact_event_t& event, std::int64_t incarnation, HostTime release);
  void release_one(const HeldEvent& held);

  SimClockTracker clock_;
  RecentMap<std::int64_t, Known> memory_{kRemembered};       // by event id
  RecentMap<std::int64_t, ContactSpan> spans_{kRemembered};  // by contact id
  std::multimap<HostTime, HeldEvent> held_;                       // by the operators, until their release
  std::multimap<SimTime, contact_event_t> pending_;          // released, by the time of the event
  std::vector<contact_event_t> dropped_;
  std::int64_t epoch_ = 0, duplicates_ = 0, refused_ = 0, overflow_ = 0;
};

}  // namespace tactus::sync
