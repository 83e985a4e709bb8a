#include "haptic_node/devices/tool_track.h"

#include <tactus/header_t.hpp>
#include <tactus/touch_model_t.hpp>

#include "lcmtypes/channels.h"
#include "lcmtypes/vectors.h"
#include "sync/bus/decode.h"

namespace tactus::haptic {
namespace {

DeviceState device_state_of(const tool_state_t& m) {
  DeviceState d;
  d.position = to_eigen(m.device.position_m);
  d.orientation = to_eigen(m.device.orientation).normalized();
  d.velocity = to_eigen(m.device_velocity_m_s);
  d.spin = to_eigen(m.device_spin_rad_s);
  d.buttons = m.buttons;
  return d;
}

}  // namespace

void ToolTrack::follow(int tool) {
  tool_ = tool;
  events_.emplace(feed_.from_begin());
  simulation_ = sync::SimClockTracker(own());
  sender_ = sync::SingleSender();
}

std::optional<RecordedTick> ToolTrack::next(sync::HostTime after) {
  sync::LogEvent e;
  for (sync::HostTime arrival{}; events_ && events_->next(e, arrival);) {
    if (e.channel == channels::kTouchModel) {
      const auto m = sync::decode<touch_model_t>(e.data.data(), e.data.size());
      if (m && m->tool == tool_) simulation_.track(m->header, m->clock, arrival);
    }
    if (e.channel != channels::kToolState) continue;
    const auto m = sync::decode<tool_state_t>(e.data.data(), e.data.size());
    if (!m || m->tool != tool_) continue;
    if (const auto tick = tick_of(*m, arrival); tick && tick->at > after) return tick;
  }
  return std::nullopt;
}

std::optional<RecordedTick> ToolTrack::tick_of(const tool_state_t& m, sync::HostTime arrival) {
  RecordedTick tick;
  tick.published_ns = m.header.publish_time_ns;
  tick.seq = m.header.seq;
  tick.at = m.header.clock == feed_.clock() ? tick_start(m.header) : arrival;
  if (tick.at < arrival - kMaxTransit || tick.at > arrival + kMaxTransit) return std::nullopt;
  if (!sync::accepted(sender_.on_page(m.header, arrival))) return std::nullopt;  // a log may hold overtaken messages
  tick.device = device_state_of(m);
  return tick;
}

// A TOOL_STATE states the simulated instant of the beginning of its tick, by the clock of the touch models.
// Messages that arrived during the tick were not used in it.
sync::HostTime ToolTrack::tick_start(const header_t& header) const {
  const sync::HostTime published = sync::host_time(header.publish_time_ns);
  const auto map = simulation_.map(published);
  if (!map || header.sim_time_ns <= 0) return published;
  const sync::HostTime at = map->to_host(sync::sim_time(header.sim_time_ns));
  return at <= published && published - at <= kMaxTickDuration ? at : published;
}

}  // namespace tactus::haptic
