// Values that published laws expect for one player. A published experiment reports the mean of a group, so its band holds
// for the typical player. Another player has another pace, caution, latency or adaptation, and the law expects
// another value. The band of a check moves with the expected value and keeps its relative width: no band is wider
// for one player than for another. A player outside the published ranges of the properties is compared with the
// nearest one inside. Pure.
#pragma once

#include <array>

#include "scripts/simulated_player/observer/parameters.h"
#include "scripts/simulated_player/observer/responses.h"

namespace tactus::observer {

// Added delays, s, and difficulties, bit, of MacKenzie and Ware 1993.
inline constexpr std::array kPointingDelays_s{0.0, 0.075, 0.150, 0.225};
inline constexpr std::array kDifficulties_bit{2.0, 3.0, 4.0, 5.0, 6.0};
// Standard deviation of the places of causes, degrees: Koerding et al. 2007 (unverified).
inline constexpr double kPlacesOfCauses_deg = 12.3;

// Pointing with a late picture by two laws.
//   Delay     MT = a + (b + c r) ID (form: MacKenzie and Ware 1993, 230 + (169 + 1.03 lag) ID ms). r is the part of
//             the delay that the player has not learnt: a loop with an unknown delay settles best with a time
//             constant in proportion to it. c = 1.03 / 0.45, because the typical player does not learn 45 %.
//   Caution   The hand approaches the target with the time constant (b + c r) / ln 2, and is known the worse the
//             faster it moves. The player selects when waiting costs more time than the errors that it avoids: a
//             cautious player is slower and more exact.
struct ExpectedTrial {
  double time_s = 0;  // from the start of the movement, without the part that is the same for all difficulties
  double errors = 0;  // probability of a miss
};
ExpectedTrial expected_trial(const PlayerParameters& player, double delay_s, double difficulty_bit);

struct ExpectedPointing {
  double slope_s_bit = 0;  // without a delay
  double growth = 0;       // of the slope, s/(s bit), over the delays of the experiment
  double added_time = 0;   // at 225 ms and the mean difficulty, as a share of the time without a delay
  double errors = 0;       // at 225 ms, as a multiple of those without a delay
};
ExpectedPointing expected_pointing(const PlayerParameters& player);

// First change of force, s: the latency of the sense, and the time in which the two poles of the muscle pass 2 % of
// a step.
double expected_response_s(const PlayerParameters& player, Disturbance disturbance);

// Scatter of a reach of fixed duration against that of the typical player: in proportion to the noise that grows with
// the command (Harris and Wolpert 1998, Nature 394:780).
double expected_scatter_ratio(const PlayerParameters& player);

// Disparity of the largest shift of a sound, degrees: the causal inference of Koerding et al. 2007 for cues without
// noise, with the player's variances and prior.
double expected_peak_deg(const PlayerParameters& player);

// Shift of simultaneity after 60 taps with 100 ms, s, by the player's own rate and share of adaptation.
double expected_recalibration_s(const PlayerParameters& player);

}  // namespace tactus::observer
