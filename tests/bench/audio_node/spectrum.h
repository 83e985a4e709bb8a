// Cross spectra of two signals along a stroke: coherence and gain by bands.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

namespace tactus::bench {

struct Spectrum {
  double per_m = 0;          // spatial frequency of bin 1
  std::vector<double> x, y;  // power of each bin, mean over segments
  std::vector<std::complex<double>> cross;
};

// Welch's method: segments of `length_m`, overlapping by half, each without its mean, under a Hann window; bins up to highest_per_m.
// step_m: between samples.
inline Spectrum spectra(const std::vector<double>& x, const std::vector<double>& y, double step_m, double length_m,
                        double highest_per_m) {
  const auto n = static_cast<std::size_t>(std::lround(length_m / step_m));
  const auto bins = static_cast<std::size_t>(highest_per_m * length_m) + 1;
  Spectrum s;
  s.per_m = 1 / (static_cast<double>(n) * step_m);
  s.x.assign(bins, 0), s.y.assign(bins, 0), s.cross.assign(bins, 0);
  for (std::size_t begin = 0; begin + n <= x.size(); begin += n / 2) {
    double mean_x = 0, mean_y = 0;
    for (std::size_t i = 0; i < n; ++i) mean_x += x[begin + i], mean_y += y[begin + i];
    mean_x /= static_cast<double>(n), mean_y /= static_cast<double>(n);
    for (std::size_t k = 1; k < bins; ++k) {
      std::complex<double> fx = 0, fy = 0, turn = 1;
      const auto step = std::polar(1.0, -2 * M_PI * static_cast<double>(k) / static_cast<double>(n));
      for (std::size_t i = 0; i < n; ++i, turn *= step) {
        const double window =
            0.5 - 0.5 * std::cos(2 * M_PI * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
        fx += window * (x[begin + i] - mean_x) * turn;
        fy += window * (y[begin + i] - mean_y) * turn;
      }
      s.x[k] += std::norm(fx), s.y[k] += std::norm(fy), s.cross[k] += fx * std::conj(fy);
    }
  }
  return s;
}

struct Band {
  double from_per_m = 0, to_per_m = 0;
  double coherence = 0;  // 0 .. 1: share of x that y explains, phase included
  double gain = 0;       // root of the power of x over that of y
  double share = 0;      // of the power of y that lies in this band
};

inline Band in_band(const Spectrum& s, double from_per_m, double to_per_m) {
  Band b{from_per_m, to_per_m};
  double x = 0, y = 0, all = 0;
  std::complex<double> cross = 0;
  for (std::size_t k = 1; k < s.x.size(); ++k) {
    all += s.y[k];
    const double f = static_cast<double>(k) * s.per_m;
    if (f < from_per_m || f >= to_per_m) continue;
    x += s.x[k], y += s.y[k], cross += s.cross[k];
  }
  b.coherence = x > 0 && y > 0 ? std::norm(cross) / (x * y) : 0;
  b.gain = y > 0 ? std::sqrt(x / y) : 0;
  b.share = all > 0 ? y / all : 0;
  return b;
}

inline double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) mx += x[i] / n, my += y[i] / n;
  for (std::size_t i = 0; i < x.size(); ++i)
    xx += (x[i] - mx) * (x[i] - mx), yy += (y[i] - my) * (y[i] - my), xy += (x[i] - mx) * (y[i] - my);
  return xx > 1e-18 && yy > 1e-18 ? xy / std::sqrt(xx * yy) : 0;
}

inline double rms(const std::vector<double>& x) {
  double mean = 0, square = 0;
  for (const double v : x) mean += v / static_cast<double>(x.size());
  for (const double v : x) square += (v - mean) * (v - mean) / static_cast<double>(x.size());
  return std::sqrt(square);
}

inline double quantile(std::vector<double> x, double q) {
  if (x.empty()) return 0;
  std::sort(x.begin(), x.end());
  return x[std::min(x.size() - 1, static_cast<std::size_t>(q * static_cast<double>(x.size())))];
}

}  // namespace tactus::bench
