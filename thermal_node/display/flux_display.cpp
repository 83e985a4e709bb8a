#include "thermal_node/display/flux_display.h"

#include <cmath>

namespace tactus::thermal {
namespace {

// Properties of the plate as an ideal conductor: its controller holds its temperature for any heat flux.
constexpr double kConductivity_W_mK = 1e6;
constexpr double kHeatCapacity_J_m3K = 1e12;

}  // namespace

double FluxDisplay::step(double skin_degC, double flux_W_m2, double plate_degC, double dt_s,
                         double longest_substep_s) {
  if (dt_s > 0 && std::isfinite(plate_degC)) {
    finger_->set_object({plate_degC, std::sqrt(kConductivity_W_mK * kHeatCapacity_J_m3K), kConductivity_W_mK,
                         kHeatCapacity_J_m3K});
    // The model of the touch and the model of the finger treat the loss to the room alike, so both are in
    // equilibrium together.
    finger_->step(dt_s, contact_.conductance_W_m2K, 0, longest_substep_s);
  }
  const double forward = skin_degC - flux_W_m2 / contact_.conductance_W_m2K;
  return forward + contact_.feedback * (skin_degC - finger_degC());
}

}  // namespace tactus::thermal
