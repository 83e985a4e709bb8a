#include "audio_node/excitation/contact_motion.h"

#include <algorithm>
#include <cmath>
#include <tactus/contact_point_t.hpp>

#include "lcmtypes/vectors.h"

namespace tactus::audio {
namespace {

using Eigen::Vector3d;

// Time over which the motion of a place over a surface is observed: three snapshots at 60 Hz. Design.
constexpr double kObservation_s = 0.05;
constexpr double kLeap = 3;        // times the distance that the contact moved (design)
constexpr double kLeap_m = 0.002;  // and not below this distance (design)
// Time constant with which a place follows the received one: slightly more than a snapshot interval. Design.
constexpr double kFollow_s = 0.02;
// A motion that reverses within this time is jitter. Design: with the distance below, a speed of 1 mm/s slides.
constexpr double kJitter_s = 0.02;
constexpr double kPresliding_m = 20e-6;

// Index of the contact point that was used before: bodies have several corners.
std::size_t same_point(const contact_t& c, std::size_t side, const std::optional<Vector3d>& before) {
  if (!before) return 0;
  const auto far = [&](const contact_point_t& p) {
    return (to_eigen(side == 0 ? p.a_body_m : p.b_body_m) - *before).norm();
  };
  return static_cast<std::size_t>(
      std::min_element(c.points.begin(), c.points.end(),
                       [&](const contact_point_t& p, const contact_point_t& q) { return far(p) < far(q); }) -
      c.points.begin());
}

}  // namespace

Vector3d rolling_of(const Vector3d& a, const Vector3d& b) {
  const double together = a.dot(b);
  if (!(together > 0)) return Vector3d::Zero();
  return (a + b).normalized() * (together / std::max(a.norm(), b.norm()));
}

void Presliding::step(const Vector3d& velocity_m_s, double dt_s) {
  way_m_ = std::exp(-dt_s / kJitter_s) * way_m_ + dt_s * velocity_m_s;
}

double Presliding::moving() const {
  const double x = std::clamp(way_m_.norm() / kPresliding_m - 1, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

// Share of the sliding that is motion over this surface: 1 under a fingertip, 0 under an edge of the body itself,
// which stays in place.
double ContactMotion::share(const Vector3d& place, const Vector3d& along) {
  // A place repeats unchanged between two snapshots.
  const bool again = observed_at_m_ && place == *observed_at_m_ && observed_s_ < kObservation_s;
  if (again || !(observed_distance_m_ > 0)) return std::clamp(share_, 0.0, 1.0);
  const double went_m = observed_at_m_ ? (place - *observed_at_m_).dot(along) : observed_distance_m_;
  // A larger jump means another corner, or a repositioned body.
  if (std::abs(went_m) < kLeap * observed_distance_m_)
    share_ += (1 - std::exp(-observed_s_ / kObservation_s)) * (went_m / observed_distance_m_ - share_);
  observed_at_m_ = place;
  observed_distance_m_ = observed_s_ = 0;
  return std::clamp(share_, 0.0, 1.0);
}

void ContactMotion::follow(Side& s, const Vector3d& told_m, const Vector3d& step_m, double dt_s) {
  s.since_s += dt_s;
  if (!s.told_m) {
    s.place_m = told_m;
  } else {
    s.place_m += step_m;
    if (told_m != *s.told_m) {
      const Vector3d off = told_m - s.place_m;
      const double leap = std::max(kLeap_m, kLeap * step_m.norm() / std::max(dt_s, 1e-9) * s.since_s);
      s.place_m += off.norm() > leap ? off : Vector3d((1 - std::exp(-s.since_s / kFollow_s)) * off);
    } else if (s.since_s > kObservation_s) {
      // The received place does not change: stays there.
      s.place_m += (1 - std::exp(-dt_s / kFollow_s)) * (told_m - s.place_m);
      return;
    } else {
      return;
    }
  }
  s.told_m = told_m;
  s.since_s = 0;
}

void ContactMotion::step(const contact_t& c, const std::array<std::optional<Eigen::Quaterniond>, 2>& to_body,
                      std::size_t surest, const Vector3d& past, double dt_s) {
  point_ = same_point(c, surest, sides_[surest].told_m);
  const contact_point_t& point = c.points[point_];
  const std::array<Vector3d, 2> told{to_eigen(point.a_body_m), to_eigen(point.b_body_m)};
  observed_distance_m_ += past.norm() * dt_s, observed_s_ += dt_s;
  if (c.tool < 0 && c.kind != contact_t::SURFACE) {
    // The simulation reports the motion of the contact relative to the mean of both surfaces.
    const Vector3d rolling = to_eigen(c.rolling_velocity_m_s);
    over_.surface = {rolling + 0.5 * past, rolling - 0.5 * past};
  } else {
    const double sign = surest == 0 ? 1 : -1;
    const Vector3d by_other = sign * past;
    const Vector3d along = past.norm() > 0 ? Vector3d(*to_body[surest] * by_other.normalized()) : Vector3d::Zero();
    over_.surface[surest] = share(told[surest], along) * by_other;
    over_.surface[1 - surest] = over_.surface[surest] - by_other;
  }
  over_.rolling = rolling_of(over_.surface[0], over_.surface[1]);
  slid_.step(past, dt_s);
  rolled_.step(over_.rolling, dt_s);
  for (std::size_t i = 0; i < 2; ++i)
    if (to_body[i]) follow(sides_[i], told[i], *to_body[i] * (dt_s * over_.surface[i]), dt_s);
}

}  // namespace tactus::audio
