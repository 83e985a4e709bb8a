// Involuntary corrections of a hand that holds a place: the first change of muscle force after a push, and after a
// jump of the seen hand. Pure.
#pragma once

#include "scripts/simulated_player/observer/parameters.h"

namespace tactus::observer {

enum class Disturbance { kPush, kJump };

// Time from the disturbance to a change of the muscle's force by 2 % of its later peak, s. The arm's own impedance
// acts at once and is not counted. The player's noise levels set its gains; the response itself is computed
// without noise.
double first_response_s(const PlayerParameters& player, Disturbance disturbance);

}  // namespace tactus::observer
