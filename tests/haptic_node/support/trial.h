// One trial of touch in closed loop: a virtual hand, the renderer with any settings, and a world of one wall or one body
// that is late, far from the hand, or fails. Pure. Every figure is measured at the true ports.
#pragma once

#include <random>
#include <string>

#include "haptic_node/devices/virtual_hand.h"
#include "haptic_node/settings.gen.h"

namespace tactus::haptic::test {

// The disturbance in the middle of a trial.
enum class Failure {
  kNone,
  kModels,     // no touch model for 0.4 s
  kDevice,     // the device is lost for 0.2 s
  kNotFinite,  // the state of the device is not finite for 0.2 s
  kStall,      // no tick for a random time of up to 0.4 s
  kRestart,    // the simulation begins again
  kClock,      // the clock steps back by 1 s
};
inline constexpr int kFailures = 7;

struct TrialDef {
  Settings settings;
  HandImpedance hand;
  double mass_kg = 0;           // of the body; 0: a wall
  double stiffness_N_m = 1000;  // of the surface
  int delay_ms = 0;             // of the touch models
  int action_ms = 0;            // of the force on the body: the stage `action`
  // The simulation reports a surface only while the tool is within its margin: this distance, or the way of the tool in
  // margin_s. 0: always. A fixed surface is reported at margin_late_m to a tool that renders late models.
  double margin_m = 0, margin_s = 0, margin_late_m = 0;
  double relief_m = 0;  // height of the waves on the surface, 20 mm long
  double force_step_N = 0;
  std::string force_operators;  // attributes of a rule of a profile at the stage `force`; empty: none
  bool hits = false;  // events of hits, which begin transients
  double period_s = 0.25, depth_m = 0.012, top_m = 0.032;  // of a tap
  double hold_s = 0.04;
  int taps = 4;
  Failure failure = Failure::kNone;
  double failure_s = 0;  // when it begins, s
  double stall_s = 0;
};

struct TrialResult {
  double generated_mJ = 0;  // largest energy in an episode to hand and body, without transients
  double energy_mJ = 0;     // to the hand, in the whole trial, without transients
  // Largest energy in an episode that the stage `force` has added to the most work of the computed force, without the part that the
  // damping of the device has dissipated.
  double injected_mJ = 0;
  double observed_mJ = 0;   // the largest generated_J of the state
  double hand_N_s = 0, constraint_N_s = 0, body_N_s = 0;  // impulses along the normal, towards hand and body
  bool rung_down = true;  // the last transient has ended, and its impulse has been returned
  double received_N_s = 0;  // integral of the magnitude of the force
  double peak_N = 0, last_peak_N = 0;  // of all taps, of the last one
  double deepest_m = 0;                // of the tool under the surface, in the last tap
  double hold_N = 0, hold_m = 0;       // force and depth at the end of the last hold
  double beyond_force_N = 0;  // above the force limit
  double beyond_rise_N = 0;   // of one tick above the slew limit
  double beyond_fade_N = 0;   // above the fade of a failure, or of the return after it
  double least_coupling = 1;
  bool finite = true;
};

TrialResult run_trial(const TrialDef& def);

// The taps of sim_node/scenes/metronome.sdf: a ball of 8 mm on a board, four times a second for 6 s.
TrialDef metronome();
// A hand that presses 13 mm into that board within 0.3 s and holds it for 2.3 s; twice.
TrialDef press();

// Draws every setting of haptic_node within its range, on a logarithmic scale where the range allows, and a hand, a surface, delays,
// operators of the stage `force` and a failure. The hand has at least the mass, damping and inertia that the settings state.
TrialDef random_trial(std::mt19937& random);

// Attributes of a rule at the stage `force`, with random values.
std::string random_force_operators(std::mt19937& random);

// The limits that a trial passes, in words; empty: none.
std::string faults(const TrialDef& def, const TrialResult& r);
// For messages of tests: all values that differ from the defaults.
std::string describe(const TrialDef& def);
std::string describe(const TrialResult& r);

}  // namespace tactus::haptic::test
