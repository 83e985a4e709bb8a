#include "scripts/simulated_player/observer/delay_belief.h"

#include <algorithm>
#include <cmath>

namespace tactus::observer {

DelayBelief::DelayBelief(const DelayBeliefDef& def)
    : def_(def), start_s_(def.natural_s + def.initial_error_s), believed_s_(start_s_), observed_s_(start_s_) {}

void DelayBelief::observe(double observed_s, double judgement_sd_s) {
  if (!std::isfinite(observed_s) || !std::isfinite(judgement_sd_s)) return;
  const double off = observed_s - observed_s_;
  observed_s_ += def_.rate * off;
  variance_s2_ += def_.rate * (off * off - variance_s2_);
  judgement_s2_ += def_.rate * (judgement_sd_s * judgement_sd_s - judgement_s2_);
  const double goal = start_s_ + def_.share * (observed_s_ - start_s_);
  believed_s_ += def_.rate * (goal - believed_s_);
  noticed_s_ += def_.rate * (observed_s - believed_s() - noticed_s_);
}

double DelayBelief::variability_s() const { return std::sqrt(std::max(0.0, variance_s2_ - judgement_s2_)); }

}  // namespace tactus::observer
