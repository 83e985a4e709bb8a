// A simulated Peltier element with the controller of a real one. Pure.
#pragma once

#include "thermal_node/devices/device.h"
#include "thermal_node/display/plate_controller.h"

namespace tactus::thermal {

class SimulatedPeltier final : public Device {
 public:
  // plate_degC: initial temperature of the plate.
  SimulatedPeltier(const PeltierPlant& plant, const PlateLimits& limits, double plate_degC)
      : plant_(plant), controller_(plant, limits), state_{plate_degC, plant.room_degC} {}

  std::optional<PlateReading> step(double command_degC, double load_W, sync::HostTime now) override;

  bool simulated() const override { return true; }
  const PeltierState& state() const { return state_; }

 private:
  PeltierPlant plant_;
  PlateController controller_;
  PeltierState state_;
  std::optional<sync::HostTime> now_;
};

}  // namespace tactus::thermal
