#include "thermal_node/skin/contact_model.h"

#include <algorithm>
#include <cmath>

namespace tactus::thermal {
namespace {
constexpr double kMinPatch_m2 = 1e-6;
}

double effusivity(double conductivity_W_mK, double density_kg_m3, double specific_heat_J_kgK) {
  const double product = conductivity_W_mK * density_kg_m3 * specific_heat_J_kgK;
  return product > 0 && std::isfinite(product) ? std::sqrt(product) : 0;
}

double contact_conductance_W_m2K(double k) { return k > 0 && std::isfinite(k) ? 1870 * k / (0.37 + k) : 0; }

double contact_share(double force_N, double area_m2, const Press& p) {
  if (!(force_N > 0) || !std::isfinite(force_N) || !std::isfinite(area_m2)) return 0;
  const double area = std::max(area_m2, kMinPatch_m2);
  const double pressure_ratio = (force_N / area) / (p.reference_force_N / p.reference_area_m2);
  return std::min(1.0, area / p.reference_area_m2 * std::pow(pressure_ratio, p.pressure_exponent));
}

}  // namespace tactus::thermal
