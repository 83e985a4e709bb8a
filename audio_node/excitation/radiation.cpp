#include "audio_node/excitation/radiation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::audio {
namespace {

using std::numbers::pi;

// Places within the pulse at which its pressure is evaluated: the largest is low by 1e-4 at most.
constexpr int kPulsePlaces = 256;

}  // namespace

double radiation_m(double frequency_Hz, double radius_m) {
  const double ka = 2 * pi * frequency_Hz * radius_m / kSoundSpeed_m_s;
  return radius_m * ka * ka / std::sqrt(4 + ka * ka * ka * ka);
}

double acceleration_peak_Pa(double velocity_m_s, double length_s, double radius_m) {
  if (!(velocity_m_s > 0 && length_s > 0 && radius_m > 0)) return 0;
  // Acceleration v / T (1 - cos w x), w = 2 pi a / (c T). The response to its constant part is e^(-x) sin x, that to its cosine
  // follows by partial fractions of s^2 / ((s^2 + w^2) (s^2 + 2 s + 2)).
  const double w = 2 * pi * radius_m / (kSoundSpeed_m_s * length_s), w2 = w * w;
  const double in_phase = 2 * w2 / (4 + w2 * w2), quadrature = -w * (2 - w2) / (4 + w2 * w2);
  const double decaying_sine = 1 - 2 * (2 - w2) / (4 + w2 * w2) - in_phase;
  double peak = 0;
  for (int i = 1; i <= kPulsePlaces; ++i) {
    const double phase = 2 * pi * i / kPulsePlaces, x = phase / w, decay = std::exp(-x);
    const double response = decay * (decaying_sine * std::sin(x) + in_phase * std::cos(x)) - in_phase * std::cos(phase) -
                            quadrature * std::sin(phase);
    peak = std::max(peak, std::abs(response));
  }
  return kAirDensity_kg_m3 * kSoundSpeed_m_s * radius_m * velocity_m_s * w / (2 * pi) * peak;
}

}  // namespace tactus::audio
