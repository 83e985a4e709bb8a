#include "audio_node/spatial/hrtf.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "audio_node/spatial/diffuse_field.h"
#include "audio_node/spatial/hull.h"
#include "audio_node/spatial/onset.h"

namespace tactus::audio {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

// Length of a response after its onset: with the lead, 128 samples at 48 kHz. Design: octave levels stay within 1
// dB of the whole response.
constexpr double kLength_s = 0.0023;
constexpr double kEqualised_s = 0.001;  // resolves bands of 1 kHz. Design.
constexpr int kUncut = 2;               // number of lengths that are equalised before the rest is cut off
constexpr int kFade = 16;               // of its last samples

// A response without its delay, at another rate.
struct Aligned {
  std::vector<float> left, right;
  double interaural_delay_s = 0;
};

std::vector<float> align(std::span<const float> response, double begin, double in_Hz, double out_Hz, int taps) {
  std::vector<float> filter;
  for (int i = 0; i < taps; ++i) {
    const double t = begin + (i - Hrtf::kLead) * in_Hz / out_Hz;
    // A sample of a filter represents its integral over a step.
    filter.push_back(static_cast<float>(in_Hz / out_Hz * value_at(response, t, std::min(1.0, out_Hz / in_Hz))));
  }
  return filter;
}

std::vector<Aligned> align_all(const MeasuredHrtf& m, double rate_Hz, int taps) {
  std::vector<Aligned> all;
  for (std::size_t i = 0; i < m.directions.size(); ++i) {
    const double left = onset(m.response(i, 0)), right = onset(m.response(i, 1));
    const double later = left + m.delay(i, 0) - right - m.delay(i, 1);
    all.push_back({align(m.response(i, 0), left, m.rate_Hz, rate_Hz, taps),
                   align(m.response(i, 1), right, m.rate_Hz, rate_Hz, taps), later / m.rate_Hz});
  }
  return all;
}

// Removes the common part: it would colour every sound, and headphones add their own.
void equalise(std::vector<Aligned>& all, const std::vector<Vector3d>& directions, double rate_Hz) {
  const std::vector<double> parts = solid_angles(directions);
  std::vector<std::vector<float>> responses;
  std::vector<double> weights;
  for (std::size_t i = 0; i < all.size(); ++i) {
    responses.push_back(all[i].left), responses.push_back(all[i].right);
    weights.insert(weights.end(), 2, parts[i]);
  }
  const auto inverse = diffuse_field_inverse(responses, weights, static_cast<int>(kEqualised_s * rate_Hz));
  for (Aligned& a : all)
    for (std::vector<float>* filter : {&a.left, &a.right}) {
      const std::vector<float> before = *filter;
      for (std::size_t n = 0; n < before.size(); ++n) {
        (*filter)[n] = 0;
        for (std::size_t k = 0; k <= n && k < inverse.size(); ++k) (*filter)[n] += inverse[k] * before[n - k];
      }
    }
}

void cut(std::vector<Aligned>& all, int taps) {
  for (Aligned& a : all)
    for (std::vector<float>* filter : {&a.left, &a.right}) {
      filter->resize(static_cast<std::size_t>(taps));
      for (int i = taps - kFade; i < taps; ++i)
        (*filter)[static_cast<std::size_t>(i)] *= static_cast<float>(taps - i) / (kFade + 1.f);
    }
}

// Weights of the three corners whose sum points in the direction, as for loudspeakers (panning.h), with sum 1.
struct Corner {
  Triangle triangle;
  Eigen::Matrix3d weights_of;
};
struct Mixture {
  Triangle triangle;
  Vector3d weights;
};

std::vector<Corner> corners(const std::vector<Vector3d>& directions) {
  std::vector<Corner> all;
  for (const Triangle& t : convex_hull(directions)) {
    Eigen::Matrix3d base;
    for (int k = 0; k < 3; ++k) base.col(k) = directions[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
    if (std::abs(base.determinant()) > 1e-9) all.push_back({t, base.inverse()});
  }
  return all;
}

Mixture mixture(const std::vector<Corner>& corners, const Vector3d& direction) {
  Mixture best{{}, Vector3d::Constant(-1e9)};
  for (const Corner& c : corners) {
    const Vector3d w = c.weights_of * direction;
    if (w.minCoeff() > best.weights.minCoeff()) best = {c.triangle, w};
  }
  if (best.weights.minCoeff() < -0.01)
    throw std::runtime_error("the directions of the HRTF file do not surround the head; choose another hrtf_file");
  best.weights = best.weights.cwiseMax(0);
  best.weights /= best.weights.sum();
  return best;
}

Vector3d direction_of(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

}  // namespace

Hrtf::Hrtf(const MeasuredHrtf& m, double rate_Hz)
    : taps_((kLead + static_cast<int>(std::ceil(kLength_s * rate_Hz)) + 15) / 16 * 16) {
  const std::vector<Corner> hull = corners(m.directions);
  if (hull.empty())
    throw std::runtime_error("the directions of the HRTF file lie in one plane; choose another hrtf_file");
  std::vector<Aligned> aligned = align_all(m, rate_Hz, kUncut * taps_);
  equalise(aligned, m.directions, rate_Hz);
  cut(aligned, taps_);
  const auto n = static_cast<std::size_t>(taps_);
  filters_.resize(static_cast<std::size_t>(kAzimuths * kElevations) * 2 * n);
  delays_.resize(static_cast<std::size_t>(kAzimuths * kElevations));
  for (int e = 0; e < kElevations; ++e)
    for (int a = 0; a < kAzimuths; ++a) {
      const Mixture mix = mixture(hull, direction_of(a * kStep_deg * pi / 180, (e * kStep_deg - 90) * pi / 180));
      const std::size_t at = node(a, e);
      float* const to = filters_.data() + at * 2 * n;
      for (std::size_t k = 0; k < 3; ++k) {
        const Aligned& from = aligned[static_cast<std::size_t>(mix.triangle[k])];
        const double weight = mix.weights[static_cast<Eigen::Index>(k)];
        delays_[at] += static_cast<float>(weight * from.interaural_delay_s * rate_Hz);
        for (std::size_t i = 0; i < n; ++i) {
          to[i] += static_cast<float>(weight) * from.left[i];
          to[n + i] += static_cast<float>(weight) * from.right[i];
        }
      }
      max_delay_ = std::max(max_delay_, std::abs(delays_[at]));
    }
  const float* ahead = filters(node(0, kElevations / 2));
  double energy = 0;
  for (std::size_t i = 0; i < 2 * n; ++i) energy += static_cast<double>(ahead[i]) * static_cast<double>(ahead[i]);
  if (!(energy > 0)) throw std::runtime_error("the HRTF file is silent straight ahead; choose another hrtf_file");
  for (float& x : filters_) x *= static_cast<float>(1 / std::sqrt(energy));
  onset_samples_ = mean_onset();
}

// Each node is weighted by its part of the sphere, the cosine of its elevation.
int Hrtf::mean_onset() const {
  double sum = 0, weights = 0;
  for (int e = 0; e < kElevations; ++e)
    for (int a = 0; a < kAzimuths; ++a) {
      const std::size_t at = node(a, e);
      const float* const nearer = filters(at) + (delays_[at] > 0 ? taps_ : 0);
      const double weight = std::cos((e * kStep_deg - 90) * pi / 180);
      sum += weight * static_cast<double>(first_audible({nearer, static_cast<std::size_t>(taps_)}));
      weights += weight;
    }
  return static_cast<int>(std::lround(sum / weights));
}

std::size_t Hrtf::node(int azimuth, int elevation) const {
  return static_cast<std::size_t>(elevation * kAzimuths + azimuth % kAzimuths);
}

float Hrtf::at(const Eigen::Vector3f& direction, float* left, float* right) const {
  constexpr float kPerNode = 180 / std::numbers::pi_v<float> / kStep_deg;
  const float azimuth = std::atan2(direction.y(), direction.x()) * kPerNode;
  const float elevation = (std::asin(std::clamp(direction.z(), -1.f, 1.f))) * kPerNode + (kElevations - 1) / 2;
  const float from_back = std::clamp(azimuth + kAzimuths / 2, 0.f, static_cast<float>(kAzimuths));
  const int a = static_cast<int>(from_back), e = std::clamp(static_cast<int>(elevation), 0, kElevations - 2);
  const float x = from_back - static_cast<float>(a), y = std::clamp(elevation - static_cast<float>(e), 0.f, 1.f);
  const int column = a + kAzimuths / 2;
  const std::array<std::size_t, 4> nodes{node(column, e), node(column + 1, e), node(column, e + 1),
                                         node(column + 1, e + 1)};
  const std::array<float, 4> weights{(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y};
  using Filter = Eigen::Map<const Eigen::ArrayXf>;
  const auto mixed = [&](int offset) {
    return weights[0] * Filter(filters(nodes[0]) + offset, taps_) +
           weights[1] * Filter(filters(nodes[1]) + offset, taps_) +
           weights[2] * Filter(filters(nodes[2]) + offset, taps_) +
           weights[3] * Filter(filters(nodes[3]) + offset, taps_);
  };
  Eigen::Map<Eigen::ArrayXf>(left, taps_) = mixed(0);
  Eigen::Map<Eigen::ArrayXf>(right, taps_) = mixed(taps_);
  float delay = 0;
  for (std::size_t k = 0; k < 4; ++k) delay += weights[k] * delays_[nodes[k]];
  return delay;
}

}  // namespace tactus::audio
