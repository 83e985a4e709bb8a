// Which temperature a plate must have so that the skin on it loses the heat that it would lose to the touched
// thing.
//
// The finger rests on the plate, and what flows between them is h (skin - plate). So the plate that takes the flux
// q from skin of temperature T_s stands at T_s - q/h: that is fed forward from the model of the touch. A second
// model of skin, which touches the plate as it really is, tells how far the finger has come; its error is fed
// back. So a plate that is too slow for the first moment of a touch makes up for it after.
#pragma once

#include <memory>
#include <utility>

#include "thermal_node/skin/skin.h"

namespace tactus::thermal {

struct PlateContact {
  double conductance_W_m2K = 0;  // between finger and plate, > 0
  double feedback = 3;           // K of plate for each K that the finger is off; design: see flux_display_test.cpp
};

// Realtime-safe: yes. Not thread-safe.
class FluxDisplay {
 public:
  // finger: at rest.
  FluxDisplay(const PlateContact& contact, std::unique_ptr<Skin> finger)
      : contact_(contact), finger_(std::move(finger)) {}

  // The plate's temperature to aim at. skin_degC, flux_W_m2: of the touch as it should be felt, out of the skin;
  // plate_degC: mean over the last dt, as measured, or as commanded where nothing is measured. What is no number
  // leaves the finger as it is.
  double step(double skin_degC, double flux_W_m2, double plate_degC, double dt_s, double longest_substep_s);

  // Of the finger that rests on the plate, as far as is known.
  double finger_degC() const { return finger_->surface_degC(); }
  // Out of it into the plate.
  double finger_flux_W_m2() const { return finger_->heat_flux_W_m2(); }

 private:
  PlateContact contact_;
  std::unique_ptr<Skin> finger_;
};

}  // namespace tactus::thermal
