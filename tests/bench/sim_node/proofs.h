// Scenes with a known outcome in closed form, each reduced to one number: the error of the outcome.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/bench/sim_node/proof_engine.h"

namespace tactus::bench {

struct Proof {
  std::string what, unit;
  double limit = 0;
  std::string truth;  // the expected outcome
  std::string why;    // the reason of the limit
  std::function<double(const std::function<std::unique_ptr<Engine>()>&)> error;
};

// stand_s: time that the stacks must stand.
std::vector<Proof> free_proofs();
std::vector<Proof> contact_proofs(double stand_s);
std::vector<Proof> joint_proofs();

}  // namespace tactus::bench
