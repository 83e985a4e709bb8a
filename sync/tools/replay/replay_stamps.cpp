#include "sync/tools/replay/replay_stamps.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <tactus/clock_map_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/game_state_t.hpp>
#include <tactus/tag_values_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/world_state_t.hpp>

#include "lcmtypes/channels.h"
#include "sync/bus/decode.h"
#include "sync/log/log_header.h"

namespace tactus::sync {
namespace {

// LCM encodes big-endian, without gaps: the fingerprint, then header_t, then the other members.
constexpr std::size_t kPublish = 16, kClock = 24, kRun = 28, kIncarnation = 40, kSimHost = 64, kSimRate = 72,
                      kSimEnd = 80;

std::uint64_t get(std::span<const std::uint8_t> bytes, std::size_t at, int size = 8) {
  std::uint64_t value = 0;
  for (int i = 0; i < size; ++i) value = value << 8 | bytes[at + static_cast<std::size_t>(i)];
  return value;
}
void put(std::span<std::uint8_t> bytes, std::size_t at, std::uint64_t value, int size = 8) {
  for (int i = size - 1; i >= 0; --i, value >>= 8)
    bytes[at + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(value);
}

bool has_sim_clock(std::span<const std::uint8_t> message) {
  const auto hash = [](std::int64_t h) { return static_cast<std::uint64_t>(h); };
  static const std::array types{hash(touch_model_t::getHash()), hash(contact_events_t::getHash()),
                                hash(contact_frame_t::getHash()), hash(world_state_t::getHash()),
                                hash(game_state_t::getHash())};
  return message.size() >= kSimEnd && std::find(types.begin(), types.end(), get(message, 0)) != types.end();
}

Nanoseconds slowed(Nanoseconds d, double speed) {
  return Nanoseconds(std::llround(std::clamp(static_cast<double>(d.count()) / speed, -4e18, 4e18)));
}

// The times of tagged values, on the same clock as the header's.
void restamp_values(std::span<std::uint8_t> message, std::int64_t sent_ns, HostTime publish, double speed) {
  auto values = decode<tag_values_t>(message.data(), message.size());
  if (!values) return;
  for (std::int64_t& t : values->times_ns) {
    const std::int64_t ago = sent_ns - std::clamp(t, sent_ns - 60'000'000'000, sent_ns);
    t = std::max<std::int64_t>(0, to_ns(publish - slowed(Nanoseconds(ago), speed)));
  }
  values->encode(message.data(), 0, static_cast<int>(message.size()));
}

}  // namespace

ReplayStamps::ReplayStamps(const LogOrigin& origin, Identity live)
    : origin_(origin), live_(std::move(live)), maps_(origin.info.header.run_id) {}

void ReplayStamps::observe(const LogEvent& event, const ReplayMoment& moment) {
  if (event.channel == channels::kClockMap)
    if (const auto map = decode<clock_map_t>(event.data.data(), event.data.size()))
      maps_.observe(*map, moment.recorded);
}

bool ReplayStamps::restamp(std::span<std::uint8_t> message, const ReplayMoment& moment, HostTime now) {
  const auto header = peek_header(message.data(), message.size());
  if (!header) return false;
  if (moment.pass != pass_ || senders_.size() > kMaxSenders) senders_.clear();
  pass_ = moment.pass;
  const OwnClock recorder(origin_.info.header.run_id, origin_.info.header.clock, &maps_);
  SenderClock& sender = senders_.try_emplace({header->source, header->incarnation}, recorder).first->second;
  sender.observe(*header, moment.recorded);
  // No message arrives before it was sent; a damaged stamp may claim so.
  const HostTime sent = std::clamp(sender.to_host(header->publish_time_ns, moment.recorded),
                                   moment.recorded - Nanoseconds(60'000'000'000), moment.recorded);
  const HostTime publish = std::min(now, moment.live - slowed(moment.recorded - sent, moment.speed));

  const std::uint64_t key[] = {static_cast<std::uint64_t>(header->incarnation),
                               static_cast<std::uint64_t>(live_.incarnation),
                               static_cast<std::uint64_t>(moment.pass)};
  const std::int64_t incarnation = std::max<std::int64_t>(1, fnv1a_64(key, sizeof key) & INT64_MAX);
  put(message, kPublish, static_cast<std::uint64_t>(to_ns(publish)));
  put(message, kClock, static_cast<std::uint64_t>(live_.clock), 4);
  put(message, kRun, static_cast<std::uint64_t>(live_.run_id));
  put(message, kIncarnation, static_cast<std::uint64_t>(incarnation));
  if (get(message, 0) == static_cast<std::uint64_t>(tag_values_t::getHash())) {
    restamp_values(message, header->publish_time_ns, publish, moment.speed);
    return true;
  }
  if (!has_sim_clock(message)) return true;
  const auto host_ns = static_cast<std::int64_t>(get(message, kSimHost));
  const auto rate = std::bit_cast<double>(get(message, kSimRate));
  // An invalid clock pair is left unchanged; its receivers refuse it.
  const std::int64_t since =
      header->publish_time_ns - std::clamp(host_ns, std::int64_t{0}, header->publish_time_ns);
  if (host_ns < 0 || host_ns > header->publish_time_ns + 60'000'000'000 || !std::isfinite(rate)) return true;
  const Nanoseconds ahead(std::max<std::int64_t>(0, host_ns - header->publish_time_ns));
  const HostTime host = publish - slowed(Nanoseconds(since), moment.speed) + slowed(ahead, moment.speed);
  put(message, kSimHost, static_cast<std::uint64_t>(std::max<std::int64_t>(0, to_ns(host))));
  put(message, kSimRate, std::bit_cast<std::uint64_t>(std::min(kMaxRate, rate * moment.speed)));
  return true;
}

}  // namespace tactus::sync
