// A population of simulated players: each property has a published range, and scrambled Sobol points choose the
// players. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scripts/simulated_player/observer/parameters.h"

namespace tactus::observer {

// How a number came here. kVerified: read in the paper's abstract or in public source code. kSecondHand: read in a
// source that quotes the paper. kUnverified: from general knowledge; check the paper before quoting it. kDesign: a
// choice of this project.
enum class Evidence { kVerified, kSecondHand, kUnverified, kDesign };
const char* evidence_name(Evidence evidence);

// Quantile functions between the 5 % point `low`, the median `centre` and the 95 % point `high`.
//   kLogNormal       log-normal on each side of the median, through all three numbers
//   kUniform         uniform between low and high; centre is not used
//   kLogUniform      uniform in the logarithm between low and high; centre is not used
//   kNormal          normal with median `centre`, through `high`
//   kBeta44          beta distribution with both parameters 4; the numbers are not used
//   kPiecewise       linear between the three numbers
enum class Spread { kLogNormal, kUniform, kLogUniform, kNormal, kBeta44, kPiecewise };

// Properties of one group are correlated in the population.
enum class Group { kNone, kLatency, kNoise };

struct ParameterRange {
  const char* name;
  int row;  // number of the property in the published list, 1 to 25; several coordinates may share one
  double PlayerParameters::*field;
  const char* unit;  // of low, centre and high
  double to_si;      // factor from that unit to the unit of the field
  double low, centre, high;
  Spread spread;
  Group group;
  Evidence evidence;
  const char* source;
};

// All properties, in the order of the Sobol coordinates.
const std::vector<ParameterRange>& parameter_ranges();

// Value in the unit of the field at quantile u in (0, 1). Published ranges are 5-95 %, and nothing is published
// about the tails: u is mapped to 0.05 to 0.95, so that no player lies outside a published range.
double value_at(const ParameterRange& range, double u);

// Player `index` of the population of this seed. The first 2^m players are a balanced design. Latencies correlate
// with 0.6 and noise levels with 0.3, by a Gaussian copula with one common factor each (design).
PlayerParameters player_of(std::uint32_t index, std::uint64_t seed);

}  // namespace tactus::observer
