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
#include <type_traits>
#include <utility>
#include <vector>

#include "lcmtypes/page_limits.h"
#include "sync/bus/page_assembler.h"
#include "sync/bus/recent_map.h"
#include "sync/degradation/decision_record.h"
#include "sync/degradation/motion_codec.h"
#include "sync/degradation/operator_chain.h"
#include "sync/degradation/snapshot.h"
#include "sync/degradation/stream_pace.h"
#include "sync/degradation/touch_forces.h"

namespace tactus::sync {

// A message that waits for its release.
template <class Message>
struct WaitingMessage {
  Message message;
  HostTime arrival;
  std::uint64_t order = 0;  // of its snapshot, by arrival
  Decision decision{};
  HostTime decided{};  // arrival of the first page of its snapshot
};

// Messages in the order of their release time; equal times keep their order. Bounded: when it is full, the oldest message is
// dropped.
template <class Message>
class DelayQueue {
 public:
  // Enough for the longest delay of a profile, one minute, of a stream of 1 kHz.
  static constexpr std::size_t kMax = 1 << 16;
  void push(HostTime release, WaitingMessage<Message> m) {
    waiting_.emplace(release, std::move(m));
    if (waiting_.size() > kMax) waiting_.erase(waiting_.begin());
  }
  std::optional<WaitingMessage<Message>> pop(HostTime now) {
    if (waiting_.empty() || waiting_.begin()->first > now) return std::nullopt;
    auto first = std::move(waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
    return first;
  }

 private:
  std::multimap<HostTime, WaitingMessage<Message>> waiting_;
};

// Snapshots. The profile decides once per snapshot, on its first page; the other pages share the decision. A deadband
// compares all values of a snapshot: then the decision falls on the last page, and the other pages wait for it. While the world
// stands still, its snapshots are repeated; each repetition is decided on as a snapshot of its own.
//
// A jitter shifts the instants at which snapshots are presented. With a delay of the network that is their release. With a
// presentation delay the renderer samples the state of a delayed instant, so each snapshot is moved to a later or earlier
// simulated time, and is held back by the delay, so that a newer snapshot can replace it before it is presented.
template <class Message>
class DegradedSnapshots {
 public:
  // For a servo loop, which renders the newest message: its presentation delay holds back messages, by an earlier `now` of pop.
  void present_on_release() { presents_on_release_ = true; }
  // Delivered messages keep their own publication time, clock and arrival: for a receiver that sums over them.
  void keep_stamps() { keeps_stamps_ = true; }
  // For a receiver that follows a hand: a message that a deadband suppresses is delivered all the same, as late as the sent ones,
  // with the motion that the receiver has without it (motion_codec.h).
  void reconstruct_motion() { reconstructs_motion_ = true; }
  // decisions: list to which decisions are appended; null: none.
  void push(Message m, HostTime arrival, OperatorChain& operators, Decisions* decisions) {
    record_newest(m, arrival);
    const SimTime time = sim_time(m.header.sim_time_ns);
    if constexpr (requires { m.pages; })
      if (m.pages > 1 && spans_profiles(m)) return;
    if (decisions) decisions->insert(decisions->end(), overtaken_.begin(), overtaken_.end());
    overtaken_.clear();
    if (operators.empty()) return waiting_.push(arrival, {std::move(m), arrival, ++order_, {}, arrival});
    if (operators.lost_on_wire(wire_key(m), time)) return;
    if constexpr (requires { m.pages; }) {
      if (m.page == 0) forget_if_repeated(m);
      if (operators.compares() && m.pages > 1 && !is_decided(m))
        return collect_page(std::move(m), arrival, operators, decisions);
    }
    const Decided& decided = decide(m, arrival, signals_of(m), operators, decisions);
    release(std::move(m), arrival, decided, operators);
  }
  // From now on a new profile decides. Snapshots whose pages are arriving began under the previous profile: their remaining
  // pages are dropped, so that no receiver combines pages of two profiles.
  void change_profile() {
    for (auto& [stream, pages] : newest_snapshots_) pages.split = pages.arrived < pages.of;
    incomplete_.clear();
  }
  // The next message that is released by now, and its arrival.
  std::optional<std::pair<Message, HostTime>> pop(HostTime now) {
    while (auto next = waiting_.pop(now)) {
      if (is_overtaken(*next)) continue;
      if (!keeps_stamps_) update_header(next->message, next->arrival);
      return std::make_pair(std::move(next->message), next->arrival);
    }
    return std::nullopt;
  }

 private:
  static constexpr std::size_t kRemembered = 256;
  // Pages of a snapshot are sent before the next snapshot; up to four snapshots may be in flight at the same time, but no more
  // pages than two of the largest have.
  static constexpr PageLimits kPageLimits{.groups = 4, .pages = kMaxStatePages, .total = 2 * kMaxStatePages};
  using Pages = PageAssembler<std::pair<Message, HostTime>, std::uint64_t>;  // by snapshot_key

  // The pages of the most recent snapshot of a stream.
  struct NewestSnapshot {
    std::uint64_t key = 0;
    int arrived = 0, of = 0;
    bool split = false;
  };
  // More streams than tools and groups exist come only from corrupt messages.
  static constexpr std::size_t kStreams = 64;
  static constexpr std::size_t kMaxOvertaken = 1024;  // records that wait for the next push

  // The decision on a snapshot.
  struct Decided {
    Decision decision;
    HostTime arrival{};           // of its first page
    std::uint64_t order = 0;      // 0: not decided yet
    std::int64_t first_seq = -1;  // header.seq of its page 0; -1: has not arrived
    bool repeated = false;
  };
  // The released snapshots of a stream.
  struct Released {
    std::uint64_t newest = 0;  // order of the newest one
    SimTime time{};            // its instant, with its shift
    std::uint64_t newest_overtaken = 0;
  };

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

  // The key of a snapshot of bodies or contacts is that of its instant. A page 0 with another number repeats an instant: the
  // world stands still, or a receiver has asked for the whole world.
  void forget_if_repeated(const Message& m) {
    if constexpr (requires { m.group; }) {
      Decided& known = decided_.try_emplace(snapshot_key(m)).first;
      const bool repeats = known.first_seq >= 0 && known.first_seq != m.header.seq;
      if (repeats) known = Decided();
      known.repeated |= repeats;
      known.first_seq = m.header.seq;
    }
  }
  bool is_decided(const Message& m) const {
    const Decided* known = decided_.find(snapshot_key(m));
    return known && known->order > 0;
  }

  void release(Message m, HostTime arrival, const Decided& decided, OperatorChain& operators) {
    Decision decision = decided.decision;
    if constexpr (std::is_same_v<Message, tool_state_t>)
      if (reconstructs_motion_) follow_motion(m, decision, operators);
    if (decision.dropped()) {
      if (decision.conceal != Conceal::kZero || !make_zero(m)) return;
    } else if (operators.changes_values()) {
      change_values(m, operators, decision.paced);
    }
    // Later pages of a delayed snapshot have the same delay as the first.
    HostTime release = std::max(decision.release, arrival) + decision.shift;
    if (!presents_on_release_) {
      release += decision.jittered_delay;
      m.header.sim_time_ns = std::max<std::int64_t>(0, m.header.sim_time_ns + decision.shift.count());
    }
    if (decision.duplicated) waiting_.push(release, {m, arrival, decided.order, decision, decided.arrival});
    waiting_.push(release, {std::move(m), arrival, decided.order, decision, decided.arrival});
  }

  // Records the motion of a sent message; gives a suppressed one the motion of the receiver, and a release as late as that of a
  // sent one and not before that of the sent message that the motion follows from.
  void follow_motion(Message& m, Decision& decision, const OperatorChain& operators) {
    const SimTime t = std::max(sim_time(m.header.sim_time_ns), decision.paced);
    if (motions_.size() >= kStreams && !motions_.contains(stream_of(m))) motions_.clear();
    const DeadbandDef* const deadband = operators.deadband(t);
    if (!deadband) return void(motions_.erase(stream_of(m)));
    SentMotion& sent = motions_[stream_of(m)];
    // The sender begins without a line, too: under a new profile.
    if (decision.begins_prediction) sent = {};
    if (!decision.dropped()) {
      sent.release = decision.release + decision.shift;
      return sent.motion.add(t, m, *deadband);
    }
    if (decision.why != DropReason::kDeadband || !sent.motion.reconstruct(t, m)) return;
    decision.why = DropReason::kKept;
    decision.release = std::max(decision.release + operators.constant_delay(t) - operators.presentation_delay(t), sent.release);
  }

  // True for a snapshot that a newer one of its stream has overtaken, if the order must be kept. WORLD_STATE contains only
  // moving bodies: an overtaken one may hold the last pose of a body, so it is released, too, for an instant before that of the
  // newer one; each body takes the newest of its poses (sync/resampling/body_history.h).
  bool is_overtaken(WaitingMessage<Message>& next) {
    if (released_.size() >= kStreams && !released_.contains(stream_of(next.message))) released_.clear();
    Released& released = released_[stream_of(next.message)];
    const bool late = next.decision.newest_wins() && next.order < released.newest;
    if constexpr (requires { next.message.bodies; }) {
      if (late && next.decision.shift != Nanoseconds(0))
        next.message.header.sim_time_ns =
            std::max<std::int64_t>(0, std::min<std::int64_t>(next.message.header.sim_time_ns, to_ns(released.time) - 1));
    } else if (late) {
      record_overtaken(next, released);
      return true;
    }
    released.newest = std::max(released.newest, next.order);
    released.time = next.order == released.newest ? sim_time(next.message.header.sim_time_ns) : released.time;
    return false;
  }
  void record_overtaken(const WaitingMessage<Message>& next, Released& released) {
    if (next.decision.dropped() || next.order == released.newest_overtaken || overtaken_.size() >= kMaxOvertaken) return;
    released.newest_overtaken = next.order;  // once for all pages
    DecisionRecord record{snapshot_key(next.message), false, sim_time(next.message.header.sim_time_ns), next.decision, next.decided,
                          stream_of(next.message)};
    record.decision.why = DropReason::kOvertaken;
    overtaken_.push_back(record);
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
      const Decided decided = decide(group.pages.begin()->page.first, arrival, std::move(signals), operators, decisions);
      for (auto& [number, page] : group.pages) release(std::move(page.first), page.second, decided, operators);
    };
    // An incomplete snapshot that newer ones have overtaken is judged by its received pages: missing signals count as a
    // change.
    if (auto* whole = incomplete_.add(key, number, count, {std::move(m), arrival}, decide_group)) decide_group(*whole);
  }

  const Decided& decide(const Message& m, HostTime arrival, std::vector<Signal> signals, OperatorChain& operators,
                        Decisions* decisions) {
    const std::uint64_t key = snapshot_key(m);
    Decided& known = decided_.try_emplace(key).first;
    if (known.order > 0) return known;
    Stream& stream = stream_state(stream_of(m), m.header.incarnation);
    StreamItem item{.key = known.repeated ? mixed(key, static_cast<std::uint64_t>(m.header.seq)) : key,
                    .stream = stream_of(m),
                    .incarnation = m.header.incarnation,
                    .time = sim_time(m.header.sim_time_ns),
                    .arrival = arrival,
                    .publish_ns = m.header.publish_time_ns,
                    .paced = stream.pace.advance(sim_time(m.header.sim_time_ns), m.header.publish_time_ns),
                    .has_forces = has_forces(m),
                    .signals = {}};
    if constexpr (requires { m.applied; })
      if (operators.compares()) stream.forces.append(signals, item.time);
    item.signals = signals;
    for (const Signal& s : signals)
      if (s.quantity == Quantity::kVelocity) item.speed_m_s = std::max(item.speed_m_s, s.value.norm());
    known.decision = operators.decide(item);
    known.arrival = arrival;
    known.order = ++order_;
    if (decisions && known.decision.evaluated) decisions->push_back({key, false, item.time, known.decision, arrival, item.stream});
    return known;
  }
  // The past of one stream that its operators need; a new incarnation is another stream.
  struct Stream {
    std::int64_t incarnation = 0;
    StreamPace pace;
    TouchForces forces;
  };
  Stream& stream_state(std::uint64_t id, std::int64_t incarnation) {
    if (streams_.size() >= kStreams && !streams_.contains(id)) streams_.clear();
    Stream& stream = streams_[id];
    if (stream.incarnation != incarnation) stream = {incarnation, {}, {}};
    return stream;
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
  std::map<std::uint64_t, NewestSnapshot> newest_snapshots_;  // by stream
  std::map<std::uint64_t, Stream> streams_;                   // by stream
  std::map<std::uint64_t, Released> released_;                // by stream
  RecentMap<std::uint64_t, Decided> decided_{kRemembered};
  Decisions overtaken_;
  std::uint64_t order_ = 0;
  bool presents_on_release_ = false, keeps_stamps_ = false, reconstructs_motion_ = false;
  struct SentMotion {
    MotionCodec motion;
    HostTime release{};  // of the newest sent message
  };
  std::map<std::uint64_t, SentMotion> motions_;  // by stream
  std::int64_t incarnation_ = 0, newest_publish_ns_ = 0;
  HostTime newest_arrival_{};
  sim_clock_t newest_clock_{};
};

}  // namespace tactus::sync
