// Measurements of the skin and the muscles: force, stiffness, size, vibration and warmth. Pure.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "scripts/simulated_player/observer/noise_stream.h"
#include "scripts/simulated_player/observer/parameters.h"

namespace tactus::observer {

// A force as felt, N: the magnitude has the Weber fraction of force, the direction turns by a random angle about a
// random axis. nullopt: below the floor, not felt.
std::optional<Eigen::Vector3d> felt_force_N(const PlayerParameters& player, const Eigen::Vector3d& force_N,
                                            NoiseStream& noise);

// A stiffness, or a heat flow into the finger, as felt: with its Weber fraction. The unit is that of the argument.
double felt_stiffness(const PlayerParameters& player, double stiffness, NoiseStream& noise);
double felt_heat_flow(const PlayerParameters& player, double heat_flow, NoiseStream& noise);

// Standard deviation of the size of a thing between two fingers, m: one third of the noise of the hand's place,
// which gives the 3.3 mm that the thresholds of Ernst and Banks 2002, Nature 415:429, imply (the share is a design
// choice).
double felt_size_sd_m(const PlayerParameters& player);

// Threshold of a vibration of this frequency, Hz, in dB: a (log10(f/550 + b) / log10 b)^2 - e with b = 1 -
// 250/550, a = 62, e = 77 (psychohaptic model of the MPEG haptics reference software, read in public code). The
// minimum is at 250 Hz.
double vibration_threshold_dB(double frequency_Hz);

}  // namespace tactus::observer
