// Streams on their way from the bus to a renderer, with the operators of its profile in between. Without a profile
// they pass through untouched. Pure.
//
// A message that is let through late carries the newest publication time and clock of its stream, and the arrival
// of the message that they are of: it is old news of the world, not a message from before a restart, and says
// nothing about the clock of who sent it. Loss is judged on raw arrivals (sync/node/modality_endpoint.h).
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/sim_clock_t.hpp>
#include <utility>
#include <vector>

#include "sync/bus/page_assembler.h"
#include "sync/bus/recent_map.h"
#include "sync/degradation/operator_chain.h"
#include "sync/degradation/snapshot.h"
#include "sync/random/keyed_random.h"

namespace tactus::sync {

// One decision, for the log.
struct DecisionRecord {
  std::uint64_t key = 0;
  bool is_event = false;
  SimTime time{};
  Decision verdict;
  HostTime arrival{};
};
using Decisions = std::vector<DecisionRecord>;

// What waits to be let through, in order of its time; what is let through at the same time keeps its order.
// Bounded: when full the oldest is dropped and counted.
template <class Message>
class DelayQueue {
 public:
  // The longest delay of a profile, a minute, of a stream of 1 kHz.
  static constexpr std::size_t kMax = 1 << 16;
  void push(HostTime release, Message m, HostTime arrival) {
    waiting_.emplace(release, std::make_pair(std::move(m), arrival));
    if (waiting_.size() <= kMax) return;
    waiting_.erase(waiting_.begin());
    ++dropped_;
  }
  std::optional<std::pair<Message, HostTime>> pop(HostTime now) {
    if (waiting_.empty() || waiting_.begin()->first > now) return std::nullopt;
    auto first = std::move(waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
    return first;
  }
  bool empty() const { return waiting_.empty(); }
  std::int64_t dropped() const { return dropped_; }

 private:
  std::multimap<HostTime, std::pair<Message, HostTime>> waiting_;
  std::int64_t dropped_ = 0;
};

// What identifies one message among those that repeat or page the same thing.
template <class Message>
std::uint64_t wire_key(const Message& m) {
  return mixed(mixed(static_cast<std::uint64_t>(m.header.incarnation), static_cast<std::uint64_t>(m.header.seq)),
               static_cast<std::uint64_t>(m.header.source));
}

// Snapshots: each is decided on once, with its first page, and the others share its fate; under a deadband, which
// compares all that a snapshot tells, with its last page, for which the others wait.
template <class Message>
class DegradedSnapshots {
 public:
  // decisions: where those are noted; null: nowhere.
  void push(Message m, HostTime arrival, OperatorChain& stack, Decisions* decisions) {
    note_newest(m, arrival);
    const SimTime time = sim_time(m.header.sim_time_ns);
    if constexpr (requires { m.pages; })
      if (m.pages > 1 && of_two_profiles(m)) return;
    if (stack.empty()) return waiting_.push(arrival, std::move(m), arrival);
    if (stack.lost_on_wire(wire_key(m), time)) return;
    if constexpr (requires { m.pages; })
      if (stack.compares() && m.pages > 1 && !verdicts_.find(snapshot_key(m)))
        return gather(std::move(m), arrival, stack, decisions);
    const Decision v = verdict_on(m, arrival, signals_of(m), stack, decisions);
    put(std::move(m), arrival, v, stack);
  }
  // From now on another profile decides. The snapshots whose pages are just arriving were begun under the one
  // before: what is still to come of them is dropped, so that nobody puts halves of two profiles together.
  void change_profile() {
    for (auto& [stream, pages] : arriving_) pages.split = pages.arrived < pages.of;
    gathering_.clear();
  }
  // The next message that is let through by now, and when it arrived.
  std::optional<std::pair<Message, HostTime>> pop(HostTime now) {
    auto next = waiting_.pop(now);
    if (next) freshen(next->first, next->second);
    return next;
  }

 private:
  static constexpr std::size_t kRemembered = 256;
  // Pages of a snapshot are sent within the time to the next; four may be on their way at once. 2,000 pages of 18
  // bodies are the largest.
  static constexpr PageLimits kGathering{.groups = 4, .pages = 4096};
  using Pages = PageAssembler<std::pair<Message, HostTime>, std::uint64_t>;  // by snapshot_key

  // The pages of the snapshot of a stream that arrived last.
  struct Arriving {
    std::uint64_t key = 0;
    int arrived = 0, of = 0;
    bool split = false;
  };
  // More streams than there are tools and groups are of false messages.
  static constexpr std::size_t kStreams = 64;

  // Whether it belongs to a snapshot that was begun under another profile. While the world stands still the same
  // snapshot comes again and again, and begins anew with its first page.
  bool of_two_profiles(const Message& m) {
    if (arriving_.size() >= kStreams && !arriving_.contains(stream_of(m))) arriving_.clear();
    Arriving& now = arriving_[stream_of(m)];
    const std::uint64_t key = snapshot_key(m);
    if (now.key != key || m.page == 0) now = {key, 0, m.pages, false};
    ++now.arrived;
    return now.split;
  }

  void put(Message m, HostTime arrival, const Decision& v, OperatorChain& stack) {
    if (v.dropped()) {
      if (v.conceal != Conceal::kZero || !make_zero(m)) return;
    } else if (stack.changes_values()) {
      change_values(m, stack);
    }
    // Later pages of a snapshot that waits wait as long as its first.
    const HostTime release = std::max(v.release, arrival);
    if (v.twice) waiting_.push(release, m, arrival);
    waiting_.push(release, std::move(m), arrival);
  }

  void gather(Message m, HostTime arrival, OperatorChain& stack, Decisions* decisions) {
    const std::uint64_t key = snapshot_key(m);
    const int number = m.page, count = m.pages;
    const auto judge = [&](typename Pages::Group& group) {
      std::vector<Signal> signals;
      for (const auto& [number, page] : group.pages) {
        const std::vector<Signal> more = signals_of(page.first);
        signals.insert(signals.end(), more.begin(), more.end());
      }
      const Decision v = verdict_on(group.pages.begin()->page.first, arrival, signals, stack, decisions);
      for (auto& [number, page] : group.pages) put(std::move(page.first), page.second, v, stack);
    };
    // One that newer ones have overtaken is judged by what came of it: what is missing counts as a change.
    if (auto* whole = gathering_.add(key, number, count, {std::move(m), arrival}, judge)) judge(*whole);
  }

  Decision verdict_on(const Message& m, HostTime arrival, const std::vector<Signal>& signals, OperatorChain& stack,
                     Decisions* decisions) {
    const std::uint64_t key = snapshot_key(m);
    if (const Decision* known = verdicts_.find(key)) return *known;
    StreamItem item{.key = key,
              .stream = stream_of(m),
              .incarnation = m.header.incarnation,
              .time = sim_time(m.header.sim_time_ns),
              .arrival = arrival,
              .signals = signals};
    for (const Signal& s : signals)
      if (s.quantity == Quantity::kVelocity) item.speed_m_s = std::max(item.speed_m_s, s.value.norm());
    const Decision v = stack.decide(item);
    verdicts_.try_emplace(key, v);
    if (decisions && v.touched) decisions->push_back({key, false, item.time, v, arrival});
    return v;
  }
  void note_newest(const Message& m, HostTime arrival) {
    const bool same = m.header.incarnation == incarnation_;
    if (same && m.header.publish_time_ns < newest_publish_ns_ && !epoch(m)) return;
    incarnation_ = m.header.incarnation;
    newest_publish_ns_ = m.header.publish_time_ns;
    newest_arrival_ = arrival;
    if constexpr (requires { m.clock; }) newest_clock_ = m.clock;
  }
  bool epoch(const Message& m) const { return m.header.publish_time_ns < newest_publish_ns_ - 1'000'000'000; }
  void freshen(Message& m, HostTime& arrival) {
    if (m.header.incarnation != incarnation_) return;
    m.header.publish_time_ns = newest_publish_ns_;
    arrival = newest_arrival_;
    if constexpr (requires { m.clock; }) m.clock = newest_clock_;
  }

  DelayQueue<Message> waiting_;
  Pages gathering_{kGathering};
  std::map<std::uint64_t, Arriving> arriving_;                // by stream
  RecentMap<std::uint64_t, Decision> verdicts_{kRemembered};
  std::int64_t incarnation_ = 0, newest_publish_ns_ = 0;
  HostTime newest_arrival_{};
  sim_clock_t newest_clock_{};
};

// Events: each is decided on once, by its id, when it is first heard of; repetitions change nothing.
class DegradedEvents {
 public:
  void push(const contact_events_t& m, HostTime arrival, OperatorChain& stack, Decisions* decisions);
  // The next message that is let through by now, and when its events arrived: one with only its header and clock
  // comes through at once.
  std::optional<std::pair<contact_events_t, HostTime>> pop(HostTime now);
  // When each event arrived first, by its id, also one that was lost on the wire on purpose.
  struct Known {
    HostTime arrival{};
    bool decided = false;  // in this life of the simulation
  };
  using Memory = RecentMap<std::int64_t, Known>;
  const Memory& memory() const { return memory_; }
  // Events that the profile dropped since the last call; whoever owes them says so.
  std::vector<contact_event_t> take_dropped() { return std::exchange(dropped_, {}); }

 private:
  static constexpr std::size_t kRemembered = 8192;  // as sync/resampling/contact_stream.cpp
  static constexpr std::size_t kMaxDropped = 4096;
  bool decides(std::int64_t id);

  DelayQueue<contact_events_t> waiting_;
  contact_events_t newest_{};  // header and clock
  HostTime newest_arrival_{};  // of that
  Memory memory_{kRemembered};
  std::vector<contact_event_t> dropped_;
};

}  // namespace tactus::sync
