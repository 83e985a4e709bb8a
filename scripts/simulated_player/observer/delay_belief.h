// The player's belief about the delay of one sense, and its adaptation. Only the belief enters the estimate; the
// true delay is unknown to the player. Pure.
#pragma once

namespace tactus::observer {

struct DelayBeliefDef {
  double natural_s = 0.12;     // delay of the sense in daily life
  double initial_error_s = 0;  // believed minus natural, before any experience
  double rate = 0.063;         // for each observed pair of action and effect
  double share = 0.55;         // share of an added delay that is learnt in the end
};

// L <- L + rate (goal - L), goal = L0 + share (observed - L0): the belief ends at L0 + share * (added delay)
// (structure: Sugano, Keetels and Vroomen 2012, Frontiers in Psychology 3:246; the formula is a design choice).
// The part that is not learnt is noticed, because movements miss by it: noticed_s() drives the player's pace.
class DelayBelief {
 public:
  explicit DelayBelief(const DelayBeliefDef& def);

  // An effect of an own action was perceived after observed_s, as the player judges it, with this standard
  // deviation of the judgement. Values that are not finite are ignored: an effect that never comes teaches
  // nothing.
  void observe(double observed_s, double judgement_sd_s);
  // The age that the player believes a percept to have. Not negative.
  double believed_s() const { return believed_s_ > 0 ? believed_s_ : 0; }
  // Running mean of observed minus believed delay.
  double noticed_s() const { return noticed_s_; }
  // Standard deviation of the delay between percepts, beyond the noise of the judgement.
  double variability_s() const;

 private:
  DelayBeliefDef def_;
  double start_s_, believed_s_;
  double observed_s_;  // running mean
  double noticed_s_ = 0, variance_s2_ = 0, judgement_s2_ = 0;
};

}  // namespace tactus::observer
