// Statistics of one step's penetration recovery in an impulse world.
#pragma once

namespace tactus::sim::impulse {

struct RecoveryReport {
  int substeps = 0;           // number of substeps of the step; usually 1
  int repeated_searches = 0;  // number of contact searches repeated because bodies moved too far
  int separation_rounds = 0;  // rounds of overlap correction by positions
  int reset_units = 0;        // units that were reset to their start pose, as the last resort
  double max_overlap_m = 0;   // remaining overlap; negative: gap
};

}  // namespace tactus::sim::impulse
