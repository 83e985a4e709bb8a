#include "sync/relay/motion_line.h"

#include <algorithm>

#include "lcmtypes/channels.h"
#include "lcmtypes/valid.h"
#include "lcmtypes/vectors.h"
#include "sync/bus/decode.h"
#include "sync/degradation/snapshot.h"
#include "sync/resampling/sample_status.h"

namespace tactus::sync {
namespace {

constexpr std::int64_t kMaxGap = 1'000'000;        // of numbers; a larger one is wrong

SimTime published_at(const header_t& h) { return sim_time(h.publish_time_ns); }
SimTime published_at(const tool_state_t& m) { return published_at(m.header); }

}  // namespace

bool carries_motion(const PassRule& rule) {
  const auto& deadband = rule.thinning.deadband;
  return rule.channel == channels::kToolState && deadband && deadband->quantity != Quantity::kForce && deadband->resend_s > 0;
}

bool MotionSender::send(const tool_state_t& m, HostTime arrival) {
  if (tools_.size() >= kMaxTools && !tools_.contains(m.tool)) tools_.clear();
  Tool& tool = tools_.try_emplace(m.tool, Tool{Deadband(def_), NewestMessage(from_seconds(2 * def_.resend_s))}).first->second;
  const SimTime before = tool.newest.has_one() ? published_at(tool.newest.header()) : published_at(m);
  if (tool.newest.is_old(m.header, arrival)) return false;
  // A time ahead was wrong: the deadband would wait for it.
  if (published_at(m) < before) tool.deadband = Deadband(def_);
  return tool.deadband.send(published_at(m), signals_of(m), to_eigen(m.proxy_velocity_m_s).norm());
}

bool MotionReceiver::push(std::span<const std::uint8_t> message, HostTime arrival) {
  auto m = decode<tool_state_t>(message.data(), message.size());
  if (!m) return false;
  const Key key{m->header.source, m->tool};
  if (hands_.size() >= kMaxHands && !hands_.contains(key)) hands_.clear();
  const auto [it, is_new] = hands_.try_emplace(key, def_);
  Hand& hand = it->second;
  const header_t& before = hand.newest.header;
  if (is_new || before.incarnation != m->header.incarnation) {
    hand = Hand(def_);
    hand.seq = m->header.seq;
    hand.numbers.is_old(m->header, arrival);
  } else {
    if (hand.numbers.is_old(m->header, arrival)) return true;
    if (const std::int64_t lost = m->header.seq - before.seq - 1; lost > 0 && lost <= kMaxGap) hand.seq += lost;
    if (const double passed_ns = static_cast<double>(m->header.publish_time_ns - before.publish_time_ns); passed_ns > 0)
      hand.sim_per_publish = std::clamp(static_cast<double>(m->header.sim_time_ns - before.sim_time_ns) / passed_ns, 0.0, 1.0);
  }
  hand.newest = *m;
  hand.arrival = arrival;
  hand.motion.add(published_at(*m), *m, def_);
  m->header.seq = hand.seq++;
  // As of a late or coarse hand in the simulation: fixed surfaces then feel the same (sim_node/touch/late_hand.h).
  m->touch_status = std::max(m->touch_status, static_cast<std::int8_t>(SampleStatus::kHeld));
  arrived_.emplace_back(key, std::move(*m));
  return true;
}

std::optional<tool_state_t> MotionReceiver::motion_at(Hand& hand, HostTime now) const {
  const Nanoseconds since = now - hand.arrival;
  if (since <= Nanoseconds(0) || since > from_seconds(2 * def_.resend_s)) return std::nullopt;
  tool_state_t m = hand.newest;
  m.header.publish_time_ns += since.count();
  if (m.header.sim_time_ns >= 0) m.header.sim_time_ns += static_cast<std::int64_t>(hand.sim_per_publish * static_cast<double>(since.count()));
  m.header.seq = hand.seq++;
  m.touch_status = std::max(m.touch_status, static_cast<std::int8_t>(SampleStatus::kHeld));
  if (!hand.motion.reconstruct(published_at(m), m) || !valid(m)) return std::nullopt;
  return m;
}

void MotionReceiver::publish(HostTime now, const Out& out) {
  for (const auto& [key, m] : arrived_) out(encode(m));
  for (auto& [key, hand] : hands_) {
    const bool arrived = std::any_of(arrived_.begin(), arrived_.end(), [&of = key](const auto& a) { return a.first == of; });
    if (arrived) continue;
    if (const auto m = motion_at(hand, now)) out(encode(*m));
  }
  arrived_.clear();
}

}  // namespace tactus::sync
