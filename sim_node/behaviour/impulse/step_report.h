// Statistics of one step's penetration recovery in an impulse world.
#pragma once

namespace tactus::sim::impulse {

struct StepReport {
  int pieces = 0;        // number of pieces of the step; usually 1
  int repeated_searches = 0;  // number of contact searches repeated because bodies moved too far
  int separated = 0;     // rounds of overlap correction by positions
  int held = 0;          // units that were reset to their start pose, as the last resort
  double deepest_m = 0;  // remaining overlap; negative: gap
};

}  // namespace tactus::sim::impulse
