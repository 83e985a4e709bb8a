#include "thermal_node/devices/external.h"

#include <tactus/thermal_device_t.hpp>

namespace tactus::thermal {

void External::receive(const thermal_device_t& m, sync::HostTime arrival) {
  if (m.tool != tool_) return;
  reading_ = to_reading(m);
  arrival_ = arrival;
}

std::optional<PlateReading> External::step(double, double, sync::HostTime now) {
  if (!arrival_ || now - *arrival_ > kSilence) return std::nullopt;
  return reading_;
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
