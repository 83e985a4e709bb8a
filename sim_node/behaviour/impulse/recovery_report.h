// Statistics of one step of an impulse world: convergence of its contacts and recovery from penetration.
#pragma once

namespace tactus::sim::impulse {

struct RecoveryReport {
  int substeps = 0;           // number of substeps of the step; usually 1
  int repeated_searches = 0;  // number of contact searches repeated because bodies moved too far
  int separation_rounds = 0;  // rounds of overlap correction by positions
  int reset_units = 0;        // units that were reset to their start pose, with their impact resolved, as the last resort
  double max_overlap_m = 0;   // remaining overlap; negative: gap
  double residual_m_s = 0;    // largest change of speed that another sweep over the contacts would make
  int unconverged = 0;        // islands of contacts with a residual above the limit of convergence
  int limited = 0;            // islands whose impulses were scaled back, since they would have added energy
};

}  // namespace tactus::sim::impulse
