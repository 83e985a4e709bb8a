// Operators on single values: quantisation and a low-pass. Pure.
#pragma once

#include "sync/degradation/profile.h"

namespace tactus::sync {

// Linear: the nearest multiple of the step (mid-tread: 0 stays 0). Logarithmic: the nearest level floor * ratio^n, n >= 0, by
// ratio, with the sign kept; 0 below floor / sqrt(ratio), one half step by ratio below the floor.
double quantised(const QuantiseDef& def, double value);

// First-order low-pass over a step of dt_s, exact for a value that is constant within it.
double lowpassed(double before, double value, double cutoff_Hz, double dt_s);

}  // namespace tactus::sync
