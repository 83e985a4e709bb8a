// A display that another program drives: it reads its command from THERMAL_STATE and answers with THERMAL_DEVICE.
// Pure.
#pragma once

#include <tactus/thermal_device_t.hpp>

#include "thermal_node/devices/device.h"

namespace tactus::thermal {

class External final : public Device {
 public:
  // tool: index; messages of other tools are ignored.
  explicit External(int tool) : tool_(tool) {}

  void receive(const thermal_device_t& message, sync::HostTime arrival) override;
  std::optional<PlateReading> step(double command_degC, double load_W, sync::HostTime now) override;

 private:
  int tool_;
  PlateReading reading_;
  std::optional<sync::HostTime> arrival_;
};

// Converts a reading to a message. Of the header it sets only sim_time_ns, to -1 (no simulated instant).
thermal_device_t to_message(const PlateReading& reading, int tool);
PlateReading to_reading(const thermal_device_t& message);

}  // namespace tactus::thermal
