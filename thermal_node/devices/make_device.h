// Makes the display that the settings select.
#pragma once

#include <memory>

#include "thermal_node/devices/device.h"
#include "thermal_node/settings.gen.h"

namespace tactus::thermal {

// Null for device=none. plate_degC: initial temperature of a simulated plate.
std::unique_ptr<Device> make_device(const Settings& settings, int tool, double plate_degC);

}  // namespace tactus::thermal
