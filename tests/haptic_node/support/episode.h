// One episode of touch in closed loop: a hand with the impedance of the virtual hand, the renderer, a world of one
// wall or one body, and a bus between them that is late, thin, lossy or frozen. Pure. Every result is measured at
// the true ports, from the motion of the body, not from reports of it.
#pragma once

#include <span>
#include <vector>

#include "haptic_node/devices/virtual_hand.h"
#include "haptic_node/settings.gen.h"

namespace tactus::haptic::test {

inline constexpr double kPress_m = 0.01, kTap_m = 0.006, kPush_m = 0.12;  // depth, depth, distance

// Degradation of the touch model in transit.
struct Network {
  const char* name = "as it is";
  int delay_ms = 0;
  double rate_Hz = 1000;
  bool bursts = false;   // 30 % lost, 10 messages in a row on average (Gilbert's chain)
  bool freezes = false;  // no message for half a second, 0.7 s after the hand began
};

enum class Act {
  kPress,  // 10 mm into the surface within 0.3 s, held for 2.5 s, and out
  kTap,    // five times, 6 mm deep, at 2 Hz
  kPush    // a free body along a table, 0.12 m in 1.2 s
};

struct EpisodeDef {
  Act act = Act::kPress;
  double mass_kg = 0;           // of the body; 0: a wall
  double stiffness_N_m = 1000;  // of the surface
  Network network;
  HandImpedance hand;
  unsigned seed = 7;  // of the losses
  Settings settings;
};

struct EpisodeResult {
  // Maximum over an episode of the energy that device port and body port have given minus the energy that they
  // have received (time-domain passivity: Hannaford and Ryu 2002), mJ. A wall receives nothing. An episode ends
  // when hand and surface have been apart, without force, for 0.2 s.
  double generated_mJ = 0;
  // The same as reported by the observer of the renderer: the maximum.
  double observed_mJ = 0;
  double least_coupling = 1;  // the lowest factor of the controller
  // For the last half second of the hold: the force, its rms about its trend, that in the half second before, the
  // least of the last three, and force over depth.
  double force_N = 0, sway_N = 0, sway_before_N = 0, sway_least_N = 0, stiffness_N_m = 0;
  int swings = 0;  // number of crossings of its trend by more than 0.03 N to either side
  // Oscillates continuously without decay. A body on a spring rings by itself, at 1 kg with 0.88 of the amplitude
  // after half a second; a single disturbance by a long loss is not an oscillation.
  bool cycles() const { return swings >= 3 && sway_least_N > 0.05 && sway_N > 0.95 * sway_before_N; }
  double peak_N = 0;            // over the whole run
  double ideal_N = 0;           // of springs in series: hand, surface, support of the body; pushed along: friction
  double pushed_m = 0;          // displacement of the body
  double largest_step_N = 0;    // largest change of the force from tick to tick
  std::vector<double> tick_us;  // duration of each tick, if requested
};

// The path of the hand, which waits for a second; the centre of the tool touches at 5 mm.
MonotoneCubic path_of(Act act);

// Oscillation of a force about the straight line that fits it best: a drift is not an oscillation.
struct Sway {
  double rms_N = 0;
  int swings = 0;  // number of crossings of the line by more than 0.03 N to either side
};
Sway sway(const std::vector<double>& force_N);

EpisodeResult run_episode(const EpisodeDef& def, bool timed = false);

// Hand of the settings, finger tip, hand, arm; published values where available, see the definition.
struct HandKind {
  const char* name;
  HandImpedance impedance;
};
std::span<const HandKind> hand_kinds();

}  // namespace tactus::haptic::test
