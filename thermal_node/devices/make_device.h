// Makes the display that the settings select.
#pragma once

#include <cstdint>
#include <memory>

#include "thermal_node/devices/device.h"
#include "thermal_node/settings.gen.h"

namespace tactus::thermal {

// Null for device=none. plate_degC: initial temperature of a simulated plate. clock: id of the clock of this
// process, see External.
std::unique_ptr<Device> make_device(const Settings& settings, int tool, double plate_degC, std::int32_t clock = 0);

}  // namespace tactus::thermal
