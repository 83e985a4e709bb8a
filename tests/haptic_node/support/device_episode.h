// One episode of touch through a device with its own period and delay: a hand that holds the device, its driver, the
// session of the node, and a wall or a body. Virtual time in steps of 125 us. Every result is measured at the true
// ports: the force that acts on the hand, and its motion. Pure.
#pragma once

#include <span>
#include <vector>

#include "tests/haptic_node/support/episode.h"

namespace tactus::haptic::test {

struct DeviceEpisodeDef {
  Act act = Act::kPress;
  double mass_kg = 0;           // of the body; 0: a wall
  double stiffness_N_m = 1000;  // of the surface
  double device_Hz = 1000;      // rate of the driver; 0: a device that is read and commanded in the tick itself
  double delay_ms = 0;          // of DEVICE_STATE and of DEVICE_FORCE, each
  double jitter_ms = 0;         // of each delay: from 0 to this, evenly; messages do not overtake each other
  double loss = 0;              // share of the messages that are lost, each way
  unsigned seed = 1;            // of jitter and losses
  bool at_once = false;         // the driver applies a force on arrival, not once per period
  bool known_output = true;     // the setting of the node agrees; otherwise it has its default
  double damping_N_s_m = 10;    // of the device, to the ground
  HandImpedance hand;           // mass: of hand and device together
  // From here on the driver has this rate; negative: never.
  double slows_at_s = -1, slow_Hz = 100;
  Settings settings;  // settings.device_damping_Ns_m: the value that the node has
};

struct DeviceEpisodeResult {
  // Maximum over a contact episode of the energy that the hand and the body have received, minus the energy that they
  // have given, mJ; and the maximum that the observer reported.
  double generated_mJ = 0, observed_mJ = 0;
  double least_coupling = 1;  // the lowest factor of the controller
  // Of the last half second of the hold: mean force, its rms about its trend, the least of the last three rms, force
  // over depth.
  double force_N = 0, sway_N = 0, sway_before_N = 0, sway_least_N = 0, stiffness_N_m = 0;
  int swings = 0;
  bool cycles() const { return swings >= 3 && sway_least_N > 0.05 && sway_N > 0.95 * sway_before_N; }
  // Mean time from a state to the effect of its force, without the hold; and the stiffness that theory allows with it.
  double delay_s = 0, theory_N_m = 0;
  double peak_N = 0, energy_J = 0;  // largest force; energy given to the hand in total
  double reported_energy_J = 0;     // the same as the node reports it
  struct Sample {
    double time_s, stiffness_limit_N_m;
    bool softened;
  };
  std::vector<Sample> limits;  // each 5 ms: the limit that the node computes
};

DeviceEpisodeResult run_device_episode(const DeviceEpisodeDef& def);

// Hands that hold a device: a grip of 50 g to an arm of 2 kg.
std::span<const HandKind> device_hands();

}  // namespace tactus::haptic::test
