#include "tests/bench/cluster/cluster_record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tactus/device_force_t.hpp>
#include <tactus/media_clock_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/thermal_device_t.hpp>
#include <tactus/thermal_state_t.hpp>

#include "sync/bus/decode.h"

namespace tactus::bench {
namespace {

using namespace std::chrono_literals;

// An output whose messages come at a constant rate.
struct Output {
  const char* channel;
  const char* program;
  sync::Nanoseconds longest_gap;  // two periods
};
constexpr std::array kOutputs{Output{channels::kTouchModel, "sim_node", 2ms},
                              Output{channels::kContacts, "sim_node", 2ms},
                              Output{channels::kToolState, "haptic_node", 2ms},
                              Output{channels::kDeviceState, "arm_driver", 2ms},
                              Output{channels::kThermalState, "thermal_node", 40ms},
                              Output{channels::kThermalDevice, "thermal_device", 20ms}};
constexpr sync::Nanoseconds kHealthGap = 200ms;
constexpr const char* kHealthOf = "NODE_HEALTH of ";

double size(const vec3f_t& v) { return std::hypot(double{v.x}, double{v.y}, double{v.z}); }

}  // namespace

std::span<const TimedValue> between(const Series& series, sync::HostTime from, sync::HostTime to) {
  const auto after = [&](sync::HostTime t) {
    return std::upper_bound(series.begin(), series.end(), t, [](sync::HostTime at, const TimedValue& v) { return at < v.time; });
  };
  return {after(from), after(std::max(from, to))};
}

double largest(const Series& series, sync::HostTime from, sync::HostTime to) {
  double most = 0;
  for (const TimedValue& v : between(series, from, to)) most = std::max(most, v.value);
  return most;
}

void ClusterRecord::add(const ArmTick& tick) {
  exerted_N_.push_back({tick.time, examples::size(tick.exerted.force)});
  force_.add(tick);
}

void ClusterRecord::add(sync::HostTime time, std::string_view channel, std::span<const std::uint8_t> data) {
  if (std::any_of(kOutputs.begin(), kOutputs.end(), [&](const Output& o) { return channel == o.channel; }))
    record_gap(std::string(channel), time);
  if (channel == channels::kDeviceForce) {
    if (const auto m = sync::decode<device_force_t>(data.data(), data.size())) commanded_N_.push_back({time, size(m->force_N)});
  } else if (channel == channels::kThermalState) {
    if (const auto m = sync::decode<thermal_state_t>(data.data(), data.size())) {
      command_degC_.push_back({time, m->commanded_degC});
      commanded_heat_.add(time, m->commanded_degC);
    }
  } else if (channel == channels::kThermalDevice) {
    if (const auto m = sync::decode<thermal_device_t>(data.data(), data.size())) {
      plate_degC_.push_back({time, m->plate_degC});
      plate_heat_.add(time, m->plate_degC);
    }
  } else if (channel == channels::kNodeHealth) {
    if (const auto m = sync::decode<node_health_t>(data.data(), data.size())) record_gap(kHealthOf + m->node, time);
  } else if (channel == channels::kMediaClock && sound_start_ == sync::HostTime{}) {
    const auto m = sync::decode<media_clock_t>(data.data(), data.size());
    if (m && m->medium == "audio.wav" && m->reason == media_clock_t::START) sound_start_ = sync::host_time(m->host_time_ns);
  }
}

void ClusterRecord::record_gap(const std::string& name, sync::HostTime time) {
  Gap& gap = gaps_[name];
  if (gap.last != sync::HostTime{}) gap.longest = std::max(gap.longest, time - gap.last);
  gap.last = time;
}

void ClusterRecord::reset_gaps(sync::HostTime now) {
  for (auto& [name, gap] : gaps_) gap = {now, sync::Nanoseconds(0)};
}

std::string ClusterRecord::long_gaps(sync::HostTime now, std::string_view except) const {
  std::string text;
  for (const auto& [name, gap] : gaps_) {
    const auto* output = std::find_if(kOutputs.begin(), kOutputs.end(), [&](const Output& o) { return name == o.channel; });
    const bool known = output != kOutputs.end();
    if (known ? output->program == except : name == kHealthOf + std::string(except)) continue;
    const sync::Nanoseconds longest = std::max(gap.longest, now - gap.last);
    if (longest > (known ? output->longest_gap : kHealthGap))
      text += (text.empty() ? "" : ", ") + name + " paused for " + std::to_string(sync::to_seconds(longest)) + " s";
  }
  return text;
}

}  // namespace tactus::bench
