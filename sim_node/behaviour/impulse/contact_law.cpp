#include "sim_node/behaviour/impulse/contact_law.h"

#include "sim_node/model/behaviour_model.h"

namespace tactus::sim {
namespace {

// kShell_m: surfaces meet at this gap, so that residuals of the sweeps are not overlaps. Design value: equal to
// the allowed overlap, 10 um. kSlack_m: the part that is not corrected, a fifth, above the rounding of detectors.
constexpr double kShell_m = 1e-5, kSlack_m = 2e-6;

}  // namespace

impulse::ContactLaw contact_law(const Settings& s) {
  impulse::ContactLaw law{.sweeps = s.iterations,
                          .bounce_speed_m_s = s.bounce_speed_m_s,
                          .slop_m = kSlack_m,
                          .correction_share = s.contact_erp,
                          .max_correction_speed_m_s = s.correcting_speed_m_s,
                          .shell_m = s.groups == "dual" ? s.contact_tolerance_m : kShell_m};
  if (behaviour_model(s.solver).finite_forces) {
    law.shell_m = kShell_m;
    law.penalty = {.stiffness_N_m = s.penalty_stiffness_N_m,
                   .damping_N_s_m = s.penalty_damping_Ns_m,
                   .thickness_m = s.contact_tolerance_m - kShell_m,  // ends at the gap where surfaces meet
                   .is_explicit = s.solver == "penalty_explicit",
                   .rise_m_s = s.correcting_speed_m_s};
  }
  return law;
}

}  // namespace tactus::sim
