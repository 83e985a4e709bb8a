// A stream of snapshots between bus and renderer, with the operators of the modality's profile applied. Without a profile,
// messages pass unchanged. Pure.
//
// A delayed message carries the newest publication time and clock of its stream, and the arrival of the message that they
// belong to. So it counts as old state of the world, not as a message from before a restart, and it does not affect the
// estimate of the sender's clock. Losses are counted on raw arrivals (sync/node/modality_endpoint.h).
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <tactus/sim_clock_t.hpp>
#include <utility>
#include <vector>

#include "sync/bus/page_assembler.h"
#include "sync/bus/recent_map.h"
#include "sync/degradation/decision_record.h"
#include "sync/degradation/operator_chain.h"
#include "sync/degradation/snapshot.h"

namespace tactus::sync {

// Messages that wait for their release time, in the order of that time; equal times keep their order. Bounded: when it is
// full, the oldest message is dropped.
template <class Message>
class DelayQueue {
 public:
  // Enough for the longest delay of a profile, one minute, of a stream of 1 kHz.
  static constexpr std::size_t kMax = 1 << 16;
  void push(HostTime release, Message m, HostTime arrival) {
    waiting_.emplace(release, std::make_pair(std::move(m), arrival));
    if (waiting_.size() > kMax) waiting_.erase(waiting_.begin());
  }
  std::optional<std::pair<Message, HostTime>> pop(HostTime now) {
    if (waiting_.empty() || waiting_.begin()->first > now) return std::nullopt;
    auto first = std::move(waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
    return first;
  }

 private:
  std::multimap<HostTime, std::pair<Message, HostTime>> waiting_;
};

// Snapshots. The profile decides once per snapshot, on its first page; the other pages share the decision. A deadband
// compares all values of a snapshot: then the decision falls on the last page, and the other pages wait for it.
template <class Message>
class DegradedSnapshots {
 public:
  // decisions: list to which decisions are appended; null: none.
  void push(Message m, HostTime arrival, OperatorChain& operators, Decisions* decisions) {
    record_newest(m, arrival);
    const SimTime time = sim_time(m.header.sim_time_ns);
    if constexpr (requires { m.pages; })
      if (m.pages > 1 && spans_profiles(m)) return;
    if (operators.empty()) return waiting_.push(arrival, std::move(m), arrival);
    if (operators.lost_on_wire(wire_key(m), time)) return;
    if constexpr (requires { m.pages; })
      if (operators.compares() && m.pages > 1 && !decided_.find(snapshot_key(m)))
        return collect_page(std::move(m), arrival, operators, decisions);
    const Decision decision = decide(m, arrival, signals_of(m), operators, decisions);
    release(std::move(m), arrival, decision, operators);
  }
  // From now on a new profile decides. Snapshots whose pages are arriving began under the previous profile: their remaining
  // pages are dropped, so that no receiver combines pages of two profiles.
  void change_profile() {
    for (auto& [stream, pages] : newest_snapshots_) pages.split = pages.arrived < pages.of;
    incomplete_.clear();
  }
  // The next message that is released by now, and its arrival.
  std::optional<std::pair<Message, HostTime>> pop(HostTime now) {
    auto next = waiting_.pop(now);
    if (next) update_header(next->first, next->second);
    return next;
  }

 private:
  static constexpr std::size_t kRemembered = 256;
  // Pages of a snapshot are sent before the next snapshot; up to four snapshots may be in flight at the same time. The largest
  // has 2,000 pages of 18 bodies.
  static constexpr PageLimits kPageLimits{.groups = 4, .pages = 4096};
  using Pages = PageAssembler<std::pair<Message, HostTime>, std::uint64_t>;  // by snapshot_key

  // The pages of the most recent snapshot of a stream.
  struct NewestSnapshot {
    std::uint64_t key = 0;
    int arrived = 0, of = 0;
    bool split = false;
  };
  // More streams than tools and groups exist come only from corrupt messages.
  static constexpr std::size_t kStreams = 64;

  // True when the page belongs to a snapshot that began under another profile. While the world stands still, the same
  // snapshot is repeated; it starts again with its first page.
  bool spans_profiles(const Message& m) {
    if (newest_snapshots_.size() >= kStreams && !newest_snapshots_.contains(stream_of(m))) newest_snapshots_.clear();
    NewestSnapshot& now = newest_snapshots_[stream_of(m)];
    const std::uint64_t key = snapshot_key(m);
    if (now.key != key || m.page == 0) now = {key, 0, m.pages, false};
    ++now.arrived;
    return now.split;
  }

  void release(Message m, HostTime arrival, const Decision& decision, OperatorChain& operators) {
    if (decision.dropped()) {
      if (decision.conceal != Conceal::kZero || !make_zero(m)) return;
    } else if (operators.changes_values()) {
      change_values(m, operators);
    }
    // Later pages of a delayed snapshot have the same delay as the first.
    const HostTime release = std::max(decision.release, arrival);
    if (decision.duplicated) waiting_.push(release, m, arrival);
    waiting_.push(release, std::move(m), arrival);
  }

  void collect_page(Message m, HostTime arrival, OperatorChain& operators, Decisions* decisions) {
    const std::uint64_t key = snapshot_key(m);
    const int number = m.page, count = m.pages;
    const auto decide_group = [&](typename Pages::Group& group) {
      std::vector<Signal> signals;
      for (const auto& [number, page] : group.pages) {
        const std::vector<Signal> more = signals_of(page.first);
        signals.insert(signals.end(), more.begin(), more.end());
      }
      const Decision decision = decide(group.pages.begin()->page.first, arrival, signals, operators, decisions);
      for (auto& [number, page] : group.pages) release(std::move(page.first), page.second, decision, operators);
    };
    // An incomplete snapshot that newer ones have overtaken is judged by its received pages: missing signals count as a
    // change.
    if (auto* whole = incomplete_.add(key, number, count, {std::move(m), arrival}, decide_group)) decide_group(*whole);
  }

  Decision decide(const Message& m, HostTime arrival, const std::vector<Signal>& signals, OperatorChain& operators,
                     Decisions* decisions) {
    const std::uint64_t key = snapshot_key(m);
    if (const Decision* known = decided_.find(key)) return *known;
    StreamItem item{.key = key,
              .stream = stream_of(m),
              .incarnation = m.header.incarnation,
              .time = sim_time(m.header.sim_time_ns),
              .arrival = arrival,
              .signals = signals};
    for (const Signal& s : signals)
      if (s.quantity == Quantity::kVelocity) item.speed_m_s = std::max(item.speed_m_s, s.value.norm());
    const Decision decision = operators.decide(item);
    decided_.try_emplace(key, decision);
    if (decisions && decision.evaluated) decisions->push_back({key, false, item.time, decision, arrival});
    return decision;
  }
  void record_newest(const Message& m, HostTime arrival) {
    const bool same = m.header.incarnation == incarnation_;
    if (same && m.header.publish_time_ns < newest_publish_ns_ && !is_restart(m)) return;
    incarnation_ = m.header.incarnation;
    newest_publish_ns_ = m.header.publish_time_ns;
    newest_arrival_ = arrival;
    if constexpr (requires { m.clock; }) newest_clock_ = m.clock;
  }
  bool is_restart(const Message& m) const { return m.header.publish_time_ns < newest_publish_ns_ - 1'000'000'000; }
  void update_header(Message& m, HostTime& arrival) {
    if (m.header.incarnation != incarnation_) return;
    m.header.publish_time_ns = newest_publish_ns_;
    arrival = newest_arrival_;
    if constexpr (requires { m.clock; }) m.clock = newest_clock_;
  }

  DelayQueue<Message> waiting_;
  Pages incomplete_{kPageLimits};
  std::map<std::uint64_t, NewestSnapshot> newest_snapshots_;                // by stream
  RecentMap<std::uint64_t, Decision> decided_{kRemembered};
  std::int64_t incarnation_ = 0, newest_publish_ns_ = 0;
  HostTime newest_arrival_{};
  sim_clock_t newest_clock_{};
};

}  // namespace tactus::sync
