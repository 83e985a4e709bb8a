// Which of a sequence is lost: each by itself, or in bursts. Pure.
#pragma once

#include <cstdint>

namespace tactus::sync {

// What a profile asks for: "5%" or "5% burst=3".
struct LossDef {
  double share = 0;       // 0 .. 1 of all are lost, in the long run
  double mean_burst = 0;  // mean length of a run of losses, >= 1; 0: independent
};

// The chain of Gilbert 1960 in its simplest form, all lost in the bad state and none in the good one, given by
// what can be observed (Elliott 1963 allows losses in both): from bad to good with probability 1/burst, from good
// to bad with share / (burst (1 - share)).
class Loss {
 public:
  // Throws std::invalid_argument with one sentence when there is no such chain: share 0 .. 1, burst >= 1 and
  // >= share / (1 - share).
  explicit Loss(const LossDef& def);

  // True: this one is lost. u: uniform in (0, 1), drawn for it.
  bool lose(double u);

 private:
  double to_bad_, stay_bad_;  // probabilities
  double share_;
  bool begun_ = false;
  bool bad_ = false;
};

}  // namespace tactus::sync
