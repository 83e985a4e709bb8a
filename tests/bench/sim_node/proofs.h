// Scenes whose outcome is known in closed form, each run to one number: how far the outcome is from the truth.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/bench/sim_node/proof_engine.h"

namespace tactus::bench {

struct Proof {
  std::string what, unit;
  double limit = 0;
  std::string truth;  // what the outcome is to be
  std::string why;    // the limit
  std::function<double(const std::function<std::unique_ptr<Engine>()>&)> error;
};

// stand_s: how long the stacks have to stand.
std::vector<Proof> free_proofs();
std::vector<Proof> contact_proofs(double stand_s);
std::vector<Proof> joint_proofs();

}  // namespace tactus::bench
