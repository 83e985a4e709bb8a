// Command-line options of the playout policy: of sync_node, and of the program that changes the policy of a running cluster.
#pragma once

#include <string>

#include "sync/playout/policy.h"
#include "sync/text/arguments.h"

namespace tactus::sync {

struct PlayoutOptions {
  std::string policy, aligner, base, budget, soa;  // empty: not given

  // named: the policy is an option, --policy; otherwise it is the program's first argument.
  void add_to(Arguments& app, bool named);
  // An asynchrony without a policy means experiment. Throws std::invalid_argument with one sentence.
  PlayoutPlan plan() const;
};

}  // namespace tactus::sync
