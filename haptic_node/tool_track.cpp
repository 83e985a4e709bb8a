#include "haptic_node/tool_track.h"

#include <algorithm>
#include <tactus/log_info_t.hpp>

#include "lcmtypes/channels.h"
#include "lcmtypes/vectors.h"
#include "sync/decode.h"

namespace tactus::haptic {
namespace {

DeviceState device_of(const tool_state_t& m) {
  DeviceState d;
  d.position = to_eigen(m.device.position_m);
  d.orientation = to_eigen(m.device.orientation).normalized();
  d.velocity = to_eigen(m.device_velocity_m_s);
  d.spin = to_eigen(m.device_spin_rad_s);
  d.buttons = m.buttons;
  return d;
}

}  // namespace

ToolTrack::ToolTrack(const std::string& log, std::int32_t clock, sync::HostTime begin, sync::HostTime end)
    : file_(log), scanner_(file_.bytes()), clock_(clock), begin_(begin), end_(end) {}

void ToolTrack::follow(int tool) {
  tool_ = tool;
  scanner_ = sync::LogScanner(file_.bytes());
  incarnation_ = 0;
}

std::optional<RecordedTick> ToolTrack::next(sync::HostTime after) {
  for (sync::LogEvent e; scanner_.next(e);) {
    if (e.channel == channels::kLogInfo && realtime_offset_ns_ == 0)
      if (const auto info = sync::decode<log_info_t>(e.data.data(), e.data.size()))
        realtime_offset_ns_ = info->realtime_offset_ns;
    if (e.channel != channels::kToolState) continue;
    const auto m = sync::decode<tool_state_t>(e.data.data(), e.data.size());
    if (!m || m->tool != tool_) continue;
    constexpr std::int64_t kMost_us = 4'000'000'000'000'000;  // as LogFeed: in ns it is still a number
    const auto arrival =
        sync::host_time(std::clamp(e.timestamp_us, -kMost_us, kMost_us) * 1000 - realtime_offset_ns_);
    if (const auto tick = tick_of(*m, arrival); tick && tick->at > after) return tick;
  }
  return std::nullopt;
}

std::optional<RecordedTick> ToolTrack::tick_of(const tool_state_t& m, sync::HostTime arrival) {
  if (arrival < begin_ - kMostUnderWay || arrival > end_) return std::nullopt;
  RecordedTick tick;
  tick.published_ns = m.header.publish_time_ns;
  tick.seq = m.header.seq;
  tick.at = m.header.clock == clock_ ? sync::host_time(tick.published_ns) : arrival;
  if (tick.at < arrival - kMostUnderWay || tick.at > arrival + kMostUnderWay) return std::nullopt;
  if (m.header.incarnation != incarnation_ && incarnation_ != 0 && arrival - heard_ < kSilence)
    return std::nullopt;
  incarnation_ = m.header.incarnation;
  heard_ = arrival;
  tick.device = device_of(m);
  return tick;
}

}  // namespace tactus::haptic
