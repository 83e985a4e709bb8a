// What it took that nothing was in anything after a step of an impulse world.
#pragma once

namespace tactus::sim::impulse {

struct StepReport {
  int pieces = 0;        // in which the step was done; 1: the usual case
  int found_again = 0;   // times that bodies came further than their contacts had been sought
  int separated = 0;     // rounds in which overlaps were put apart
  int held = 0;          // units that stayed where they were, as nothing else kept them apart
  double deepest_m = 0;  // overlap that is left; negative: gap
};

}  // namespace tactus::sim::impulse
