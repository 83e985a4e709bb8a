#include "sync/playout/options.h"


namespace tactus::sync {

void PlayoutOptions::add_to(Arguments& app, bool named) {
  app.add_option(named ? "--policy" : "POLICY", policy,
                 "when each sense presents an event: asap, aligned, experiment, local_haptic_first or itouch2005");
  app.add_option(
      "--aligner", aligner,
      "method that estimates the delay of a modality: quantile (default) or fixed");
  app.add_option("--base", base, "common delay of experiment and of the aligner fixed; default: 150ms");
  app.add_option("--budget", budget,
                 "maximum delay; other modalities do not wait for one that needs more; default: 60ms");
  app.add_option("--soa", soa, "of experiment: asynchrony of senses, e.g. audio=50ms,visual=-20ms");
}

PlayoutPlan PlayoutOptions::plan() const {
  PlayoutPlan plan;
  if (!policy.empty())
    plan.policy = parse_policy(policy);
  else if (!soa.empty())
    plan.policy = Policy::kExperiment;
  if (!aligner.empty()) plan.aligner = parse_aligner(aligner);
  if (!base.empty()) plan.base = parse_duration(base);
  if (!budget.empty()) plan.budget = parse_duration(budget);
  if (!soa.empty()) plan.soa = parse_soa(soa);
  plan.check();
  return plan;
}

}  // namespace tactus::sync
