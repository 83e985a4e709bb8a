#include "sync/clock_sync/clock_probe.h"

#include <algorithm>

namespace tactus::sync {

std::optional<clock_probe_t> probe_reply(const clock_probe_t& request, const Identity& own, HostTime arrived) {
  if (request.kind != clock_probe_t::REQUEST || request.header.run_id != own.run_id || request.header.clock == own.clock)
    return std::nullopt;
  clock_probe_t reply = request;
  reply.kind = clock_probe_t::REPLY;
  reply.request_arrived_ns = to_ns(arrived);
  return reply;
}

HostTime ClockProber::next() const {
  const auto sent = static_cast<int>(sent_.size());
  if (sent < kProbes) return wave_begin_ + sent * kSpacing;
  return wave_begin_ + (kProbes - 1) * kSpacing + kMaxRoundTrip;
}

std::optional<clock_probe_t> ClockProber::request(HostTime now, HostTime stamp, std::int64_t nonce) {
  if (static_cast<int>(sent_.size()) == kProbes || now < next()) return std::nullopt;
  // After a stall the spacing is kept: answers to a burst would delay each other.
  if (now > next() + kSpacing) wave_begin_ = now - static_cast<int>(sent_.size()) * kSpacing;
  sent_.push_back({nonce, to_ns(stamp)});
  clock_probe_t m{};
  m.kind = clock_probe_t::REQUEST;
  m.asking_clock = own_.clock;
  m.nonce = nonce;
  m.request_sent_ns = to_ns(stamp);
  m.request_arrived_ns = m.reply_sent_ns = -1;
  return m;
}

bool ClockProber::accepts(const clock_probe_t& r, HostTime returned) const {
  if (r.kind != clock_probe_t::REPLY || r.header.run_id != own_.run_id || r.asking_clock != own_.clock ||
      r.header.clock == own_.clock)
    return false;
  const auto requested = [&](const Sent& s) { return s.nonce == r.nonce && s.sent_ns == r.request_sent_ns; };
  if (std::none_of(sent_.begin(), sent_.end(), requested)) return false;
  const Nanoseconds round_trip_time = returned - host_time(r.request_sent_ns);
  const Nanoseconds remote_time(r.reply_sent_ns - r.request_arrived_ns);
  return remote_time >= Nanoseconds(0) && remote_time <= round_trip_time && round_trip_time <= kMaxRoundTrip;
}

void ClockProber::reply(const clock_probe_t& r, HostTime returned) {
  if (r.kind == clock_probe_t::REPLY && r.asking_clock != own_.clock) return;  // addressed to another process
  const auto known = replies_.find(r.header.clock);
  const bool has_room = known != replies_.end() ? known->second.wave.replies < 2 * kProbes : replies_.size() < kMaxClocks;
  if (!accepts(r, returned) || !has_room) return;
  const HostTime sent = host_time(r.request_sent_ns), arrived = host_time(r.request_arrived_ns),
                 replied = host_time(r.reply_sent_ns);
  const ProbeWave wave{r.header.clock, probe_sample(sent, arrived, replied, returned),
                       (returned - sent) - (replied - arrived), 1};
  // From any instant of the wave, the clocks drift by no more than over its whole length.
  const Nanoseconds margin = wave.sample.half_width + Nanoseconds(static_cast<std::int64_t>(
                                                          OffsetTracker::kMaxDrift * static_cast<double>(kPeriod.count())));
  const ClockReplies replies{wave, wave.sample.offset - margin, wave.sample.offset + margin};
  if (known == replies_.end()) {
    replies_.emplace(r.header.clock, replies);
    return;
  }
  ClockReplies& before = known->second;
  before.min_offset = std::max(before.min_offset, replies.min_offset);
  before.max_offset = std::min(before.max_offset, replies.max_offset);
  ++before.wave.replies;
  if (wave.round_trip >= before.wave.round_trip) return;
  before.wave.sample = wave.sample;
  before.wave.round_trip = wave.round_trip;
}

std::vector<ProbeWave> ClockProber::finish(HostTime now) {
  std::vector<ProbeWave> out;
  if (static_cast<int>(sent_.size()) < kProbes || now < next()) return out;
  // Answers that contradict each other are left out: the clock jumped meanwhile, or one was forged.
  for (const auto& [clock, replies] : replies_)
    if (replies.min_offset <= replies.max_offset) out.push_back(replies.wave);
  Nanoseconds period = kPeriod * std::max<std::int64_t>(1, static_cast<std::int64_t>(out.size() / kFewClocks));
  if (waves_.size() > kMaxClocks) waves_.clear();  // limits the memory when hosts come and go for months
  for (const ProbeWave& wave : out)
    if (waves_[wave.clock] < kFirstWaves && ++waves_[wave.clock] < kFirstWaves) period = kFirstPeriod;
  replies_.clear();
  sent_.clear();
  wave_begin_ = std::max(wave_begin_ + period, now);
  return out;
}

}  // namespace tactus::sync
