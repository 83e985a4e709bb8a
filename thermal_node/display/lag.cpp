#include "thermal_node/display/lag.h"

#include <algorithm>
#include <cmath>

namespace tactus::thermal {

double Lag::step(double x, double dt_s, double response_s) {
  if (std::isfinite(x)) y_ = response_s > 0 ? x + (y_ - x) * std::exp(-std::max(0.0, dt_s) / response_s) : x;
  return y_;
}

}  // namespace tactus::thermal
