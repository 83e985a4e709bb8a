// Draws the lost items of a sequence: independently, or in bursts. Pure.
#pragma once

namespace tactus::sync {

// The loss of a profile: "5%" or "5% burst=3".
struct LossDef {
  double share = 0;       // long-run share of lost items, 0 .. 1
  double mean_burst = 0;  // mean length of a run of losses, >= 1; 0: independent
};

// The Gilbert 1960 chain in its simplest form, with all items lost in the bad state and none in the good one, parametrised by
// observable quantities (Elliott 1963 allows losses in both): from bad to good with probability 1/burst, from good to bad
// with share / (burst (1 - share)).
class Loss {
 public:
  // Throws std::invalid_argument with one sentence when no such chain exists: share 0 .. 1, burst >= 1 and >= share / (1 -
  // share).
  explicit Loss(const LossDef& def);

  // Returns true when this item is lost. u: uniform in (0, 1), drawn for it.
  bool lose(double u);

 private:
  double to_bad_, stay_bad_;  // probabilities
  double share_;
  bool started_ = false;
  bool bad_ = false;
};

}  // namespace tactus::sync
