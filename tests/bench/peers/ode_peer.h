// ODE for comparisons: sim_node's solvers quick and step.
#pragma once

#include "sim_node/behaviour/solver.h"

namespace tactus::sim::test {

class OdePeer : public Solver {
 public:
  // The velocities at the start are those of half a step before, because ODE adds a whole step of gravity before it moves a body.
  static constexpr bool kStartsEarlier = true;
  using Solver::Solver;
};

}  // namespace tactus::sim::test
