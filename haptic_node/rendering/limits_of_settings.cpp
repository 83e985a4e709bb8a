#include "haptic_node/rendering/limits_of_settings.h"

#include <algorithm>

namespace tactus::haptic {
namespace {

// Ticks in one period of the fastest transient. Design: fewer do not show a vibration.
constexpr double kTicksPerPeriod = 3;

}  // namespace

SurfaceLimits surface_limits(const Settings& s) {
  return {s.recovery_time_s, s.recovery_speed_m_s, s.recovery_turn_rad_s, s.max_extrapolation_s,
          s.surface_speed_limit_m_s};
}

CouplingLimits coupling_limits(const Settings& s) {
  return {s.stiffness_limit_N_m, s.mass_factor,         s.damping_ratio,
          s.device_mass_kg,      s.device_damping_Ns_m, kHeldDamping_N_s_m};
}

ReliefDef reliefs_of(const Settings& s) {
  return relief_def(s.bump, s.bump_steepest, s.recovery_time_s, s.recovery_speed_m_s);
}

PassivityLimits passivity_limits(const Settings& s, double step_s) {
  PassivityLimits limits{s.generated_limit_J, s.force_limit_N, s.surface_speed_limit_m_s};
  limits.round_trip_s = std::max(limits.round_trip_s, step_s + 1 / s.rate_Hz + hold_of_push_s(s.rate_Hz, step_s));
  return limits;
}

WallLimits wall_limits(const Settings& s) {
  return {s.generated_limit_J, s.device_mass_kg, s.device_inertia_kgm2, s.device_damping_Ns_m,
          s.device_turn_damping_Nms_rad};
}

InjectedLimits injected_limits(const Settings& s) {
  return {s.generated_limit_J,   s.device_mass_kg,      s.device_inertia_kgm2, s.device_damping_Ns_m,
          s.device_turn_damping_Nms_rad, s.stiffness_limit_N_m};
}

TransientShape transient_shape(const Settings& s) {
  const double fastest_Hz = s.rate_Hz / kTicksPerPeriod;
  return {s.transient_gain,
          s.transient_limit_N,
          std::min(s.transient_soft_frequency_Hz, fastest_Hz),
          std::min(s.transient_hard_frequency_Hz, fastest_Hz),
          s.transient_decay_1_s,
          {kLatePolicy, sync::from_seconds(s.late_tolerance_s),
           sync::from_seconds(std::max(s.late_tolerance_s, s.drop_after_s))}};
}

}  // namespace tactus::haptic
