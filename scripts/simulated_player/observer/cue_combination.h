// Combination of cues by their reliability, and the decision whether two cues have one cause. Pure.
#pragma once

#include <span>

namespace tactus::observer {

// One cue about one quantity. The variance is positive; an infinite variance is a cue without information.
struct Cue {
  double value = 0;
  double variance = 1;
};

// Maximum-likelihood estimate: weights in proportion to 1/variance (Ernst and Banks 2002, Nature 415:429). Cues
// without information do not count; when none has information, the result has value 0 and an infinite variance.
Cue combine(std::span<const Cue> cues);

// Variance of a cue about a thing that moves: its own noise plus the diffusion of the thing during the cue's age,
// sd_m^2 + process_noise * age_s (Crevecoeur, Munoz and Scott 2016, Journal of Neuroscience 36:8598).
double aged_variance_m2(double sd_m, double age_s, double process_noise_m2_s);

// Causal inference of Koerding et al. 2007, PLoS ONE 2:e943: do two cues a and b have one cause? The prior of a
// cause's value has mean 0 and this variance; common_cause is the prior probability of one cause.
struct CausalInference {
  double common = 0;  // posterior probability of one cause
  double a = 0;       // estimate for the source of a: the average over both hypotheses
  double b = 0;
};
CausalInference infer_cause(const Cue& a, const Cue& b, double prior_variance, double common_cause);

}  // namespace tactus::observer
