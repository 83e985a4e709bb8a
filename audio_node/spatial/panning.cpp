#include "audio_node/spatial/panning.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "audio_node/spatial/hull.h"

namespace tactus::audio {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using std::numbers::pi;

constexpr double kLevel = 0.02;  // sine of 1 degree: loudspeakers within it are level
// Pairs further apart give no stable image between them; a pair of 180 degrees has no base.
constexpr double kWidestPair = 170 * pi / 180;  // design
// A triangle nearer to the listener than this leaves a gap: sine of 10 degrees, as for pairs.
constexpr double kNearestTriangle = 0.17;  // design

Vector3d around(double azimuth) { return {std::cos(azimuth), std::sin(azimuth), 0}; }

}  // namespace

Panning::Panning(const Layout& layout) : channels_(static_cast<int>(layout.size())) {
  std::vector<Vector3d> directions;
  for (int i = 0; i < channels_; ++i)
    if (const auto& d = layout[static_cast<std::size_t>(i)]) {
      channel_of_.push_back(i);
      directions.push_back(*d);
    }
  real_ = static_cast<int>(directions.size());
  flat_ = std::all_of(directions.begin(), directions.end(),
                      [](const Vector3d& d) { return std::abs(d.z()) < kLevel; });
  if (flat_)
    build_pairs(std::move(directions));
  else
    build_triangles(std::move(directions));
}

// Neighbours around the listener; a virtual loudspeaker is placed in the middle of a gap.
void Panning::build_pairs(std::vector<Vector3d> level) {
  const auto azimuth = [&](int i) {
    const Vector3d& d = level[static_cast<std::size_t>(i)];
    return std::atan2(d.y(), d.x());
  };
  std::vector<int> order(level.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return azimuth(a) < azimuth(b); });
  const auto pair = [&](int a, int b) {
    Eigen::Matrix3d base = Eigen::Matrix3d::Identity();
    base.col(0) = around(azimuth(a)), base.col(1) = around(azimuth(b));
    if (std::abs(base.determinant()) > 1e-6) bases_.push_back({{a, b, -1}, base.inverse().cast<float>()});
  };
  for (std::size_t k = 0; k < order.size(); ++k) {
    const int a = order[k], b = order[(k + 1) % order.size()];
    double gap = azimuth(b) - azimuth(a);
    if (gap <= 0) gap += 2 * pi;
    if (gap < kWidestPair) {
      pair(a, b);
      continue;
    }
    // A gap of more than half of the circle is divided twice.
    const int steps = static_cast<int>(std::ceil(gap / kWidestPair));
    int last = a;
    for (int s = 1; s < steps; ++s) {
      level.push_back(around(azimuth(a) + gap * s / steps));
      const int empty = static_cast<int>(level.size()) - 1;
      rims_.push_back({a, b});
      pair(last, empty);
      last = empty;
    }
    pair(last, b);
  }
}

// Adds virtual loudspeakers, above or below a ring, until the listener is well within the hull.
void Panning::build_triangles(std::vector<Vector3d> directions) {
  const auto normal_of = [&](const Triangle& t) {
    const auto at = [&](std::size_t i) { return directions[static_cast<std::size_t>(t[i])]; };
    return Vector3d((at(1) - at(0)).cross(at(2) - at(0)).normalized());
  };
  std::vector<Triangle> hull = convex_hull(directions);
  for (int tries = 0; tries < 6; ++tries) {
    std::set<int> rim;
    Vector3d open = Vector3d::Zero();
    for (const Triangle& t : hull) {
      const Vector3d normal = normal_of(t);
      if (normal.dot(directions[static_cast<std::size_t>(t[0])]) >= kNearestTriangle) continue;
      // Coplanar triangles form one gap.
      if (open.isZero()) open = normal;
      if (open.dot(normal) < 0.99) continue;
      for (const int i : t)
        if (i < real_) rim.insert(i);
    }
    if (hull.empty()) {  // fewer than four, or all coplanar: nothing is opposite to their middle
      Vector3d middle = Vector3d::Zero();
      for (const Vector3d& d : directions) middle += d;
      open = middle.norm() > 1e-6 ? Vector3d(-middle.normalized()) : Vector3d(-Vector3d::UnitZ());
      for (int i = 0; i < real_; ++i) rim.insert(i);
      if (tries > 0) open = open.unitOrthogonal();
    }
    if (open.isZero()) break;
    if (rim.empty())  // between virtual ones
      for (int i = 0; i < real_; ++i) rim.insert(i);
    directions.push_back(open);
    rims_.emplace_back(rim.begin(), rim.end());
    hull = convex_hull(directions);
  }
  for (const Triangle& t : hull) {
    Eigen::Matrix3d base;
    for (int k = 0; k < 3; ++k) base.col(k) = directions[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
    if (std::abs(base.determinant()) > 1e-6) bases_.push_back({t, base.inverse().cast<float>()});
  }
}

void Panning::gains(const Vector3f& direction, float* of_channels) const {
  std::fill(of_channels, of_channels + channels_, 0.f);
  Vector3f d = direction;
  float height = 0;
  if (flat_) {
    height = std::abs(d.z());
    d.z() = 0;
    const float level = d.norm();
    d = level > 1e-3f ? Vector3f(d / level) : Vector3f::UnitX();
  }
  const Base* best = nullptr;
  Vector3f best_gains = Vector3f::Zero();
  float best_least = -1e9f;
  for (const Base& base : bases_) {
    const Vector3f g = base.gains_of * d;
    const float least = flat_ ? std::min(g.x(), g.y()) : g.minCoeff();
    if (least > best_least) best = &base, best_gains = g, best_least = least;
  }
  const auto add_power = [&](int speaker, float power) {
    of_channels[channel_of_[static_cast<std::size_t>(speaker)]] += power;
  };
  // The gains are combined as powers; a source above a level ring is distributed over the whole ring.
  float sum = 0;
  if (best) best_gains = best_gains.cwiseMax(0.f), sum = best_gains.head(flat_ ? 2 : 3).squaredNorm();
  for (int k = 0; best && sum > 0 && k < (flat_ ? 2 : 3); ++k) {
    const int speaker = best->speakers[static_cast<std::size_t>(k)];
    const float power = best_gains[k] * best_gains[k] / sum * (1 - height);
    if (speaker < real_) {
      add_power(speaker, power);
    } else {
      const auto& rim = rims_[static_cast<std::size_t>(speaker - real_)];
      for (const int i : rim) add_power(i, power / static_cast<float>(rim.size()));
    }
  }
  const float rest = best && sum > 0 ? height : 1;
  for (int i = 0; i < real_; ++i) add_power(i, rest / static_cast<float>(real_));
  for (int i = 0; i < channels_; ++i) of_channels[i] = std::sqrt(of_channels[i]);
}

}  // namespace tactus::audio
