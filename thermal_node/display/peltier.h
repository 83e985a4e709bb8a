// A thermoelectric module between a plate that skin touches and a heat sink: the effect of current and heat on
// both temperatures.
//
//   plate:  C_p dT_p/dt = load - (S I T_p - I^2 R/2 - K (T_s - T_p))
//   sink:   C_s dT_s/dt = S I T_s + I^2 R/2 - K (T_s - T_p) - (T_s - room)/R_s
//
// S Seebeck, R electric resistance, K conduction through the module, T absolute; I > 0 pumps heat from the plate
// into the sink (cools the plate). The standard lumped model of such modules (Rowe, CRC Handbook of
// Thermoelectrics, 1995). Pure.
#pragma once

namespace tactus::thermal {

// Values of a data sheet, for a hot side at hot_K.
struct PeltierDataSheet {
  double current_max_A;             // at the largest temperature difference
  double voltage_max_V;             // at that current and difference
  double temperature_difference_K;  // largest, without load
  double hot_K = 300.15;
};

// ElectraCool TM 31-1.4-8.5 (electracool.com/TM-31-14-85.html): 20 x 20 x 3.4 mm, 31 couples, hot side at 27 degC.
// The other values of the sheet, 0.35 ohm +- 10 % and 18.8 W pumped without a difference, serve to check the
// model.
inline constexpr PeltierDataSheet kTm31_14_85{8.5, 3.8, 70};

struct PeltierModule {
  double seebeck_V_K = 0;
  double resistance_ohm = 0;
  double conductance_W_K = 0;

  // From the three equations at the operating point of the data sheet: no load, the largest difference, d(load)/dI
  // = 0. They give S = V/T_h, R = V (T_h - dT)/(I T_h), K = V I (T_h - dT)/(2 T_h dT).
  static PeltierModule from(const PeltierDataSheet& sheet);
};

struct PeltierPlant {
  PeltierModule module = PeltierModule::from(kTm31_14_85);
  // Plate: 20 x 20 x 0.7 mm of 96 % alumina (3700 kg/m^3, 750 J/(kg K): gnaxel.ru, Al2O3 substrates) 0.78 J/K;
  // half of the legs and the copper under it 0.12 J/K (design: 62 legs of 1.4 x 1.4 x 1.3 mm of bismuth
  // telluride).
  double plate_J_K = 0.9;
  // Design: 40 g of aluminium with a fan.
  double sink_J_K = 36;
  double sink_to_room_K_W = 1.5;
  double room_degC = 23;
};

struct PeltierState {
  double plate_degC = 33;
  double sink_degC = 23;
};

// Heat that the module removes from the plate, W.
double pumped_W(const PeltierModule& module, const PeltierState& state, double current_A);
// The current that pumps this heat, or the one that pumps most.
double current_for_A(const PeltierModule& module, const PeltierState& state, double pumped_W);
double voltage_V(const PeltierModule& module, const PeltierState& state, double current_A);

// State after dt with constant current and load (W, from the skin into the plate): midpoint rule, for dt well
// below the seconds in which plate and sink change (1 ms). Realtime-safe: yes.
PeltierState step(const PeltierPlant& plant, const PeltierState& state, double current_A, double load_W,
                  double dt_s);

}  // namespace tactus::thermal
