#include "thermal_node/devices/external.h"

#include <tactus/thermal_device_t.hpp>

namespace tactus::thermal {

void External::receive(const thermal_device_t& m, sync::HostTime arrival) {
  if (m.tool != tool_) return;
  const DatedSender::Result result = sender_.observe(m.header, arrival);
  if (result == DatedSender::Result::kUse || result == DatedSender::Result::kRestart) reading_ = to_reading(m);
}

std::optional<PlateReading> External::step(double, double, sync::HostTime now) {
  if (sender_.silent(now) || sender_.conflict(now)) return std::nullopt;
  return reading_;
}

const char* External::problem(sync::HostTime now) const {
  if (sender_.conflict(now))
    return "two programs send THERMAL_DEVICE for its tool: the plate is neutral; stop one of them";
  if (sender_.ahead(now))
    return "THERMAL_DEVICE is dated ahead: the plate is neutral; check the clock of the display's program";
  if (sender_.followed() == 0)
    return "no display answers: the plate is neutral; start its program, or set device=none";
  if (sender_.silent(now)) return "the display is silent: the plate is neutral; check its program";
  return sender_.trusted(now) ? nullptr : "the display has begun to answer: the plate is neutral for a moment";
}

thermal_device_t to_message(const PlateReading& r, int tool) {
  thermal_device_t m{};
  m.header.sim_time_ns = -1;
  m.tool = tool;
  m.plate_degC = static_cast<float>(r.plate_degC);
  m.sink_degC = static_cast<float>(r.sink_degC);
  m.current_A = static_cast<float>(r.current_A);
  m.voltage_V = static_cast<float>(r.voltage_V);
  m.state = r.fault ? thermal_device_t::FAULT : r.limited ? thermal_device_t::LIMITED : thermal_device_t::OK;
  return m;
}

PlateReading to_reading(const thermal_device_t& m) {
  return {m.plate_degC,
          m.sink_degC,
          m.current_A,
          m.voltage_V,
          m.state == thermal_device_t::LIMITED,
          m.state == thermal_device_t::FAULT};
}

}  // namespace tactus::thermal
