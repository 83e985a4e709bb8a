// The plate temperature for which the skin on the plate loses the same heat as to the touched object.
//
// The finger rests on the plate, and the flux between them is h (skin - plate). For a flux q from skin of
// temperature T_s the plate must be at T_s - q/h: this is the feed-forward part, from the model of the touch. A
// second skin model, in contact with the measured plate, estimates the real finger temperature; its error is fed
// back. A plate that is too slow for the first moment of a touch therefore compensates afterwards. An intended change of the
// command, too, would be compensated: take it out of plate_degC before step().
#pragma once

#include <memory>
#include <utility>

#include "thermal_node/skin/skin.h"

namespace tactus::thermal {

struct PlateContact {
  double conductance_W_m2K = 0;  // between finger and plate, > 0
  double feedback = 3;           // K of plate per K of error of the finger; design: see flux_display_test.cpp
};

// Realtime-safe: yes. Not thread-safe.
class FluxDisplay {
 public:
  // finger: at rest.
  FluxDisplay(const PlateContact& contact, std::unique_ptr<Skin> finger)
      : contact_(contact), finger_(std::move(finger)) {}

  // Returns the target temperature of the plate. skin_degC, flux_W_m2: of the touch to render, flux out of the
  // skin; plate_degC: mean over the last dt, measured, or commanded without a measurement. A value that is not
  // finite leaves the finger unchanged.
  double step(double skin_degC, double flux_W_m2, double plate_degC, double dt_s, double longest_substep_s);

  // Estimated temperature of the finger on the plate.
  double finger_degC() const { return finger_->surface_degC(); }
  // From the finger into the plate.
  double finger_flux_W_m2() const { return finger_->heat_flux_W_m2(); }

 private:
  PlateContact contact_;
  std::unique_ptr<Skin> finger_;
};

}  // namespace tactus::thermal
