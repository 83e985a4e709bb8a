// An oracle for the temperature of skin that touches an object: two semi-infinite bodies with a contact resistance,
// in closed form, for one uninterrupted contact.
//
// Carslaw and Jaeger, Conduction of Heat in Solids, 1959, section 2.5 (solution with a boundary conductance), in
// the form that Ho and Jones (2008, "Modeling the thermal responses of the skin surface during hand-object
// interactions") use for touch.
#pragma once

#include <cmath>
#include <numbers>

namespace tactus::thermal::test {

// The scaled complementary error function, exp(x^2) erfc(x), without overflow. Relative error below 1e-14. x >= 0
// or NaN; 0 for infinity.
inline double erfcx(double x) {
  // Above this value the continued fraction converges to double precision in kTerms terms. Below it the erfc of the
  // C library is far from its underflow (x = 26), and exp(x^2) loses at most x^2 units of rounding, 16 here.
  constexpr double kSwitch = 4;
  constexpr int kTerms = 60;
  if (x < kSwitch) return std::exp(x * x) * std::erfc(x);
  // Laplace's continued fraction (Abramowitz and Stegun 1964, 7.1.14), from its tail: sqrt(pi) erfcx(x) = 1/(x +
  // (1/2)/(x + (2/2)/(x + (3/2)/(x + ...)))).
  double tail = x;
  for (int n = kTerms; n >= 1; --n) tail = x + 0.5 * n / tail;
  return std::numbers::inv_sqrtpi / tail;
}

// One contact that begins at t = 0 and lasts.
struct SteadyContact {
  double skin_effusivity;
  double object_effusivity;
  double conductance_W_m2K;
  double skin_degC;    // before
  double object_degC;  // before

  // Of the skin surface, t seconds after the touch.
  double skin_surface_degC(double t_s) const {
    const double share = object_effusivity / (skin_effusivity + object_effusivity);
    return skin_degC - (skin_degC - object_degC) * share * (1 - erfcx(beta() * std::sqrt(t_s)));
  }
  // Out of the skin, W/m^2.
  double heat_flux_W_m2(double t_s) const {
    return conductance_W_m2K * (skin_degC - object_degC) * erfcx(beta() * std::sqrt(t_s));
  }
  // Of the interface when the resistance no longer matters.
  double contact_degC() const {
    return (skin_effusivity * skin_degC + object_effusivity * object_degC) / (skin_effusivity + object_effusivity);
  }
  // s^-1/2: conductance (1/e_skin + 1/e_object)
  double beta() const { return conductance_W_m2K * (1 / skin_effusivity + 1 / object_effusivity); }
};

}  // namespace tactus::thermal::test
