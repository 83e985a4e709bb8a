// The lines that ask a simulated participant for trials, and the answers. Pure.
#pragma once

#include <memory>
#include <string>

#include "scripts/experiments/paradigms.h"

namespace tactus::experiments {

// Lines:
//   participant INDEX SEED                   the next trials are of this participant; answers "ok"
//   trial PARADIGM NUMBER [NAME=VALUE]...    one trial; answers "ok NAME=VALUE ..."
// A wrong line is answered by "error SENTENCE", and changes nothing.
class TrialDesk {
 public:
  std::string answer(const std::string& line);

 private:
  std::string answered(const std::string& line);

  std::unique_ptr<Participant> participant_;
};

// CSV: paradigm, property, evidence, source: the properties on which each paradigm depends.
std::string properties_table();

}  // namespace tactus::experiments
