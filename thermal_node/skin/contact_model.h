// Effusivity of a material, and the conductance of the contact between it and a finger pad.
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
  // h ~ pressure^0.95 for solids with rough surfaces (Yovanovich 1982, Thermal contact correlations, AIAA; Cooper, Mikic
  // and Yovanovich 1969 have 0.985; both unverified). Its use for skin is a design assumption: Ho and Jones 2008 state
  // that pressure changes the resistance, but not by which law.
  double pressure_exponent = 0.95;
};

// Share 0 .. 1 of that conductance, averaged over the pad, when only `area` of it touches with `force`:
// area/reference times (pressure/reference)^n, at most 1. An area below 1 mm^2 counts as 1 mm^2: a point contact
// of the simulation is rendered as the smallest patch that skin can form.
double contact_share(double force_N, double area_m2, const Press& press);

}  // namespace tactus::thermal
