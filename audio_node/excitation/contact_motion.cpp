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
constexpr double kMaxRatio = 3;        // times the distance that the contact moved (design)
constexpr double kMinJump_m = 0.002;  // and not below this distance (design)
// Time constant with which a place follows the received one: slightly more than a snapshot interval. Design.
constexpr double kSmoothing_s = 0.02;
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
  displacement_m_ = std::exp(-dt_s / kJitter_s) * displacement_m_ + dt_s * velocity_m_s;
}

double Presliding::moving() const {
  const double x = std::clamp(displacement_m_.norm() / kPresliding_m - 1, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

// Share of the sliding that is motion over this surface: 1 under a fingertip, 0 under an edge of the body itself,
// which stays in place.
double ContactMotion::motion_share(const Vector3d& place, const Vector3d& along) {
  // A place repeats unchanged between two snapshots.
  const bool again = observed_at_m_ && place == *observed_at_m_ && observed_s_ < kObservation_s;
  if (again || !(observed_distance_m_ > 0)) return std::clamp(motion_share_, 0.0, 1.0);
  const double moved_m = observed_at_m_ ? (place - *observed_at_m_).dot(along) : observed_distance_m_;
  // A larger jump means another corner, or a repositioned body.
  if (std::abs(moved_m) < kMaxRatio * observed_distance_m_)
    motion_share_ += (1 - std::exp(-observed_s_ / kObservation_s)) * (moved_m / observed_distance_m_ - motion_share_);
  observed_at_m_ = place;
  observed_distance_m_ = observed_s_ = 0;
  return std::clamp(motion_share_, 0.0, 1.0);
}

void ContactMotion::track(Side& s, const Vector3d& received_m, const Vector3d& step_m, double dt_s) {
  s.since_s += dt_s;
  if (!s.received_m) {
    s.place_m = received_m;
  } else {
    s.place_m += step_m;
    if (received_m != *s.received_m) {
      const Vector3d off = received_m - s.place_m;
      const double jump = std::max(kMinJump_m, kMaxRatio * step_m.norm() / std::max(dt_s, 1e-9) * s.since_s);
      s.place_m += off.norm() > jump ? off : Vector3d((1 - std::exp(-s.since_s / kSmoothing_s)) * off);
    } else if (s.since_s > kObservation_s) {
      // The received place does not change: stays there.
      s.place_m += (1 - std::exp(-dt_s / kSmoothing_s)) * (received_m - s.place_m);
      return;
    } else {
      return;
    }
  }
  s.received_m = received_m;
  s.since_s = 0;
}

void ContactMotion::step(const contact_t& c, const std::array<std::optional<Eigen::Quaterniond>, 2>& to_body,
                      std::size_t reference_side, const Vector3d& sliding, double dt_s) {
  point_ = same_point(c, reference_side, sides_[reference_side].received_m);
  const contact_point_t& point = c.points[point_];
  const std::array<Vector3d, 2> received{to_eigen(point.a_body_m), to_eigen(point.b_body_m)};
  observed_distance_m_ += sliding.norm() * dt_s, observed_s_ += dt_s;
  if (c.tool < 0 && c.kind != contact_t::SURFACE) {
    // The simulation reports the motion of the contact relative to the mean of both surfaces.
    const Vector3d rolling = to_eigen(c.rolling_velocity_m_s);
    velocity_.surface = {rolling + 0.5 * sliding, rolling - 0.5 * sliding};
  } else {
    const double sign = reference_side == 0 ? 1 : -1;
    const Vector3d by_other = sign * sliding;
    const Vector3d along = sliding.norm() > 0 ? Vector3d(*to_body[reference_side] * by_other.normalized()) : Vector3d::Zero();
    velocity_.surface[reference_side] = motion_share(received[reference_side], along) * by_other;
    velocity_.surface[1 - reference_side] = velocity_.surface[reference_side] - by_other;
  }
  velocity_.rolling = rolling_of(velocity_.surface[0], velocity_.surface[1]);
  sliding_detector_.step(sliding, dt_s);
  rolling_detector_.step(velocity_.rolling, dt_s);
  for (std::size_t i = 0; i < 2; ++i)
    if (to_body[i]) track(sides_[i], received[i], *to_body[i] * (dt_s * velocity_.surface[i]), dt_s);
}

}  // namespace tactus::audio
