#include "audio_node/excitation/roughness.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tactus::audio {
namespace {

// A wave is two grains long: from the cutoff of ISO 4288 to below the tip of 2 um of ISO 3274.
constexpr double kGrain_m = 0.4e-3;
constexpr int kFinest = 8;     // octave; 1.6 um
constexpr int kCoarsest = -4;  // for maps with larger pixels (design)

// Mutually orthogonal, and none along an axis of a body.
constexpr double kDirections[3][3] = {
    {2 / 3., 2 / 3., -1 / 3.}, {-1 / 3., 2 / 3., 2 / 3.}, {2 / 3., -1 / 3., 2 / 3.}};

// Mean squares of the interpolation 3 t^2 - 2 t^3 between uniform numbers of -1 .. 1, and of its derivative: 1/3 *
// 26/35 and 2/3 * 6/5.
constexpr double kSquare = 26.0 / 105, kSquareSlope = 0.8;

// A number of -1 .. 1 for each grain (splitmix64's finaliser, Steele, Lea and Flood 2014).
double grain_value(std::int64_t i, std::uint64_t seed) {
  auto z = (static_cast<std::uint64_t>(i) + seed) * 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return static_cast<double>(static_cast<std::int64_t>((z ^ (z >> 31)) >> 11)) * 0x1p-52 - 1;
}

int coarsest(const Roughness& of) {
  if (!(of.texel_m > 0)) return 0;
  return std::clamp(static_cast<int>(std::ceil(std::log2(kGrain_m / of.texel_m))), kCoarsest, kFinest + 1);
}

double grain_m(int octave) { return std::ldexp(kGrain_m, -octave); }

// Amplitude of one octave in one of the three directions. All octaves from 0 on together have the requested mean
// square.
double amplitude_m(const Roughness& of, int octave) {
  const double fall = std::exp2(-2 * kHurst);
  return of.height_m * std::sqrt((1 - fall) / (3 * kSquare)) * std::exp2(-kHurst * octave);
}

// Share of a wave that remains when a sample advances by this number of grains: all below a quarter, nothing from
// a half on. The spectrum of a grain lies at about half a wave, and is almost zero one octave above (design).
double antialias_gain(double grains) { return std::clamp(2 - 4 * std::abs(grains), 0.0, 1.0); }

}  // namespace

void add_slopes(const Roughness& of, const Track& track, const Eigen::Vector3f& along,
                const Eigen::Vector3f& along_other, int frames, float* slope, float* slope_other) {
  if (!(of.height_m > 0)) return;
  for (int octave = coarsest(of); octave <= kFinest; ++octave) {
    const double grains_m = 1 / grain_m(octave);
    const double steep = amplitude_m(of, octave) * grains_m;
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d d(kDirections[j]);
      const double x0 = d.dot(track.p) * grains_m, step = d.dot(track.step) * grains_m,
                   bend = d.dot(track.bend) * grains_m;
      const double kept_first = antialias_gain(step), kept_last = antialias_gain(step + 2 * frames * bend);
      if (kept_first <= 0 && kept_last <= 0) continue;
      const double fade = (kept_last - kept_first) / frames;
      const Eigen::Vector3f df = d.cast<float>();
      const float one = df.dot(along), other = df.dot(along_other);
      const auto seed = static_cast<std::uint64_t>(3 * (octave - kCoarsest) + j) << 40;
      double whole = std::floor(x0);
      double rise = 0;
      bool fresh = true;
      for (int n = 0; n < frames; ++n) {
        const double x = x0 + n * (step + n * bend);
        if (fresh || x < whole || x >= whole + 1) {
          whole = std::floor(x);
          const auto i = static_cast<std::int64_t>(whole);
          rise = 6 * steep * (grain_value(i + 1, seed) - grain_value(i, seed));
          fresh = false;
        }
        const double t = x - whole;
        const auto s = static_cast<float>((kept_first + n * fade) * rise * t * (1 - t));
        slope[n] += one * s;
        slope_other[n] += other * s;
      }
    }
  }
}

double mean_square_slope(const Roughness& of) {
  double sum = 0;
  for (int octave = coarsest(of); octave <= kFinest; ++octave) {
    const double steep = amplitude_m(of, octave) / grain_m(octave);
    sum += kSquareSlope * steep * steep;
  }
  return sum;
}

}  // namespace tactus::audio
