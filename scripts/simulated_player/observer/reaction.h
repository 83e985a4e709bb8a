// Reaction times. Pure.
#pragma once

#include "scripts/simulated_player/observer/noise_stream.h"
#include "scripts/simulated_player/observer/parameters.h"

namespace tactus::observer {

enum class Stimulus { kVision, kTouch, kHearing, kCold, kWarmth };

// Natural latency of the sense of a stimulus, s.
double latency_s(const PlayerParameters& player, Stimulus stimulus);

// One reaction to an expected stimulus, s: latency, muscle, and a decision that is normal plus exponential (23, 20
// and 30 ms: mean 53 ms, standard deviation 36 ms, unverified). With the typical latencies: vision 213 ms, as
// Woods, Wyma, Yund, Herron and Reed 2015, Frontiers in Human Neuroscience 9:131, report after correction for the
// hardware (second hand).
double simple_reaction_s(const PlayerParameters& player, Stimulus stimulus, NoiseStream& noise);

// Mean of simple_reaction_s.
double mean_reaction_s(const PlayerParameters& player, Stimulus stimulus);

// Added time of a choice among alternatives of equal probability: 150 ms for each bit (Hick 1952, Quarterly
// Journal of Experimental Psychology 4:11; the rate is unverified). choices: at least 1.
double choice_time_s(int choices);

}  // namespace tactus::observer
