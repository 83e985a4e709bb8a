// Temperature of skin that touches an object: two semi-infinite bodies with a contact resistance, in closed form.
//
// Carslaw and Jaeger, Conduction of Heat in Solids, 1959, section 2.5 (solution with a boundary conductance), in
// the form that Ho and Jones (2008, "Modeling the thermal responses of the skin surface during hand-object
// interactions") use for touch. It covers one uninterrupted contact; skin_model.h integrates intermittent contacts
// and is tested against this.
#pragma once

namespace tactus::thermal {

// sqrt(k rho c), W s^0.5 m^-2 K^-1: the ability of a body to hold its surface temperature. 0 for invalid input.
double effusivity(double conductivity_W_mK, double density_kg_m3, double specific_heat_J_kgK);

// Conductance h = 1/R, W/(m^2 K), between a pressed finger pad and a material of conductivity k: R = (0.37 +
// k)/(1870 k) m^2 K/W (Ho and Jones 2008); 0.37 W/(m K) is the conductivity of skin. They measured at 0.73 to
// 10.98 kPa and found their model typically within 1 K above 4 kPa; the reference press, 10 kPa, is within that.
double contact_conductance_W_m2K(double object_conductivity_W_mK);

// Pressure of the pad.
struct Press {
  double reference_force_N = 1;     // force at which contact_conductance_W_m2K holds
  double reference_area_m2 = 1e-4;  // of the whole pad
  // Cooper, Mikic and Yovanovich 1969: h ~ pressure^0.95 for solids with rough surfaces; its use for skin is a
  // design assumption. Ho and Jones 2008 state that pressure changes the resistance, but not by which law.
  double pressure_exponent = 0.95;
};

// Share 0 .. 1 of that conductance, averaged over the pad, when only `area` of it touches with `force`:
// area/reference times (pressure/reference)^n, at most 1. An area below 1 mm^2 counts as 1 mm^2: a point contact
// of the simulation is rendered as the smallest patch that skin can form.
double contact_share(double force_N, double area_m2, const Press& press);

// One contact that begins at t = 0 and lasts.
struct SteadyContact {
  double skin_effusivity;
  double object_effusivity;
  double conductance_W_m2K;
  double skin_degC;    // temperature of the skin before the touch
  double object_degC;  // temperature of the object before the touch

  // Temperature of the skin surface, t seconds after the begin of the touch.
  double skin_surface_degC(double t_s) const;
  // Heat flux out of the skin, W/m^2.
  double heat_flux_W_m2(double t_s) const;
  // Temperature of the interface after a long time, when the resistance no longer matters.
  double contact_degC() const;

 private:
  double beta() const;  // s^-1/2: conductance (1/e_skin + 1/e_object)
};

}  // namespace tactus::thermal
