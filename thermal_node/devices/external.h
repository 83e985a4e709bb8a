// A display that another program drives: it reads its command from THERMAL_STATE and answers with THERMAL_DEVICE.
// Its messages may be late, missing, repeated, wrongly dated, or come from two programs. Pure.
#pragma once

#include <tactus/thermal_device_t.hpp>

#include "thermal_node/devices/dated_sender.h"
#include "thermal_node/devices/device.h"
#include "thermal_node/display/following.h"

namespace tactus::thermal {

class External final : public Device {
 public:
  // tool: index; messages of other tools are ignored. clock: id of the clock of this process, see DatedSender.
  explicit External(int tool, std::int32_t clock = 0) : tool_(tool), sender_(kSilence, clock) {}

  void receive(const thermal_device_t& message, sync::HostTime arrival) override;
  // Empty while the display is silent or has two senders.
  std::optional<PlateReading> step(double command_degC, double load_W, sync::HostTime now) override;
  const char* problem(sync::HostTime now) const override;
  std::int64_t displays() const override { return sender_.followed(); }
  // Of an accepted display, see Following.
  double return_K_s() const override { return Following::kSlowest_K_s; }

 private:
  int tool_;
  PlateReading reading_;
  DatedSender sender_;
};

// Converts a reading to a message. Of the header it sets only sim_time_ns, to -1 (no simulated instant).
thermal_device_t to_message(const PlateReading& reading, int tool);
PlateReading to_reading(const thermal_device_t& message);

}  // namespace tactus::thermal
