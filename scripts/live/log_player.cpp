#include "scripts/live/log_player.h"

#include <algorithm>
#include <stdexcept>
#include <tactus/log_info_t.hpp>

#include "sync/bus/decode.h"

namespace tactus::live {

LogPlayer::LogPlayer(const std::string& path)
    : file_(std::make_unique<sync::MappedLog>(path)), bytes_(file_->bytes()), scan_(bytes_), scanner_(bytes_) {
  try {
    begin();
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(path + ": " + e.what());
  }
}

LogPlayer::LogPlayer(std::span<const std::uint8_t> bytes) : bytes_(bytes), scan_(bytes), scanner_(bytes) { begin(); }

void LogPlayer::begin() {
  // The offset between the stamps and the recorder's CLOCK_MONOTONIC comes first in the log. A log of LCM's own logger lacks
  // it: its stamps are then used as the clock.
  sync::LogScanner probe(bytes_);
  sync::LogEvent event;
  bool any = false;
  for (int i = 0; i < kMaxEvents && probe.next(event); ++i) {
    any = true;
    if (event.channel != channels::kLogInfo) continue;
    if (const auto info = sync::decode<log_info_t>(event.data.data(), event.data.size())) {
      offset_ns_ = info->realtime_offset_ns;
      break;
    }
  }
  if (!any) throw std::runtime_error("has no event of an LCM log; give a run.lcmlog");
  scan_next();
  begin_ = position_ = seek_points_.front().time;
  playing_ = true;
}

sync::HostTime LogPlayer::stamp(const sync::LogEvent& event) const {
  constexpr std::int64_t kMax_us = 4'000'000'000'000'000;  // the year 2096; later stamps are damaged
  const std::int64_t us = std::clamp<std::int64_t>(event.timestamp_us, 0, kMax_us);
  return sync::host_time(us * 1000 - std::clamp<std::int64_t>(offset_ns_, -kMax_us * 1000, kMax_us * 1000));
}

bool LogPlayer::scan_next() {
  sync::LogEvent event;
  for (int i = 0; i < kMaxEvents; ++i) {
    if (!scan_.next(event)) return false;
    const sync::HostTime t = scan_clock_.observe(stamp(event));
    end_ = seek_points_.empty() ? t : std::max(end_, t);
    if (!seek_points_.empty() && t < seek_points_.back().time + kSeekPointInterval) continue;
    const auto* channel = reinterpret_cast<const std::uint8_t*>(event.channel.data());
    seek_points_.push_back({t, static_cast<std::size_t>(channel - bytes_.data()) - sync::kLogEventHeaderBytes});
  }
  return true;
}

void LogPlayer::seek(double to_s) {
  const sync::HostTime to = begin_ + sync::from_seconds(std::clamp(to_s, 0.0, length_s()));
  const auto after = std::upper_bound(seek_points_.begin(), seek_points_.end(), to - kSeekLead,
                                      [](sync::HostTime t, const SeekPoint& p) { return t < p.time; });
  const SeekPoint& from = after == seek_points_.begin() ? seek_points_.front() : *std::prev(after);
  scanner_ = sync::LogScanner(bytes_.subspan(from.offset));
  clock_ = sync::SummaryClock();
  has_pending_ = false;
  position_ = to;
}

void LogPlayer::advance(sync::Nanoseconds dt, const EventHandler& on_event) {
  if (playing_)
    position_ = std::min(end_, position_ + sync::from_seconds(std::clamp(sync::to_seconds(dt), 0.0, 0.5) * rate_));
  for (int i = 0; i < kMaxEvents; ++i) {
    if (!has_pending_ && !scanner_.next(pending_)) return;
    has_pending_ = true;
    const sync::HostTime t = clock_.observe(stamp(pending_));
    if (t > position_) return;
    on_event(pending_.channel, pending_.data, t);
    has_pending_ = false;
  }
}

}  // namespace tactus::live
