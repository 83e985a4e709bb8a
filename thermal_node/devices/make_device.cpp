#include "thermal_node/devices/make_device.h"

#include <algorithm>

#include "thermal_node/devices/external.h"
#include "thermal_node/devices/simulated_peltier.h"

namespace tactus::thermal {

std::unique_ptr<Device> make_device(const Settings& s, int tool, double plate_degC, std::int32_t clock) {
  if (s.device == "external") return std::make_unique<External>(tool, clock);
  if (s.device != "peltier") return nullptr;
  PeltierPlant plant;
  plant.room_degC = s.room_degC;
  PlateLimits limits;
  // The command keeps the slew limit. A tight one must not slow down the return into a range that has become
  // narrower.
  limits.rate_K_s = std::max(limits.rate_K_s, s.slew_max_K_s);
  return std::make_unique<SimulatedPeltier>(plant, limits, plate_degC);
}

}  // namespace tactus::thermal
