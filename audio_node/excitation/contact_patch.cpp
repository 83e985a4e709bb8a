#include "audio_node/excitation/contact_patch.h"

#include <algorithm>
#include <cmath>

namespace tactus::audio {

double reduced_modulus_Pa(const Elastic& a, const Elastic& b) {
  const auto compliance = [](const Elastic& m) {
    return (1 - m.poissons_ratio * m.poissons_ratio) / m.youngs_modulus_Pa;
  };
  return 1 / (compliance(a) + compliance(b));
}

double patch_radius_m(double force_N, double curvature_1_m, double reduced_modulus_Pa) {
  return std::cbrt(3 * force_N / (4 * curvature_1_m * reduced_modulus_Pa));
}

double patch_cutoff_Hz(double speed_m_s, double patch_radius_m) {
  return speed_m_s / (2 * std::max(patch_radius_m, 1e-9));
}

double rolling_force_N(double patch_radius_m, double reduced_modulus_Pa, double effective_mass_kg,
                       double speed_m_s) {
  const double spring_N_m = 2 * reduced_modulus_Pa * patch_radius_m;
  const double pushes_rad_s = 2 * M_PI * patch_cutoff_Hz(speed_m_s, patch_radius_m);
  const double inertia = effective_mass_kg * pushes_rad_s * pushes_rad_s / spring_N_m;
  return spring_N_m * patch_radius_m / M_PI * std::min(1.0, inertia);
}

}  // namespace tactus::audio
