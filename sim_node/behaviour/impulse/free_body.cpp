#include "sim_node/behaviour/impulse/free_body.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::sim::impulse {
namespace {

// A body that rotates less than this in a step has constant angular velocity, rad: the change is of the order of its
// square, 1e-10.
constexpr double kHardlyTurns_rad = 1e-5;
// Rotation per integration piece, rad. The error of the classical Runge-Kutta step is its fifth power, 1e-4. Design
// value: a body that rotates more than 32 pieces in a step is too fast for any step.
constexpr double kPiece_rad = 0.15;
constexpr int kMaxPieces = 32;

Eigen::Matrix3d in_world(const Eigen::Quaterniond& orientation, const Eigen::Matrix3d& in_body) {
  const Eigen::Matrix3d r = orientation.toRotationMatrix();
  return r * in_body * r.transpose();
}

Eigen::Quaterniond turned(const Eigen::Quaterniond& q, const Eigen::Vector3d& by) {
  const double angle = by.norm();
  if (angle == 0) return q;
  return (Eigen::Quaterniond(Eigen::AngleAxisd(angle, by / angle)) * q).normalized();
}

// A body with equal principal inertias has constant angular velocity.
bool is_even(const Eigen::Matrix3d& inertia) {
  return (inertia - inertia(0, 0) * Eigen::Matrix3d::Identity()).norm() < 1e-9 * inertia(0, 0);
}

// Mean angular velocity over the step at constant angular momentum. spin: at its start.
Eigen::Vector3d mean_spin(const FreeBody& body, const Eigen::Vector3d& momentum, const Eigen::Vector3d& spin,
                          double step) {
  const Eigen::Matrix3d inverse = body.inertia_kg_m2.inverse();
  const auto rate = [&](const Eigen::Vector4d& q) -> Eigen::Vector4d {
    const Eigen::Quaterniond turn(q);
    const Eigen::Matrix3d r = turn.normalized().toRotationMatrix();
    const Eigen::Vector3d w = r * (inverse * (r.transpose() * momentum));
    return 0.5 * (Eigen::Quaterniond(0, w.x(), w.y(), w.z()) * turn).coeffs();
  };
  const int pieces = std::clamp(static_cast<int>(spin.norm() * step / kPiece_rad), 1, kMaxPieces);
  const double h = step / pieces;
  Eigen::Vector4d q = body.orientation.coeffs();
  for (int i = 0; i < pieces; ++i) {
    const Eigen::Vector4d a = rate(q), b = rate(q + h / 2 * a), c = rate(q + h / 2 * b), d = rate(q + h * c);
    q += h / 6 * (a + 2 * b + 2 * c + d);
    q.normalize();
  }
  const Eigen::AngleAxisd turn(Eigen::Quaterniond(q) * body.orientation.conjugate());
  // Poses do not contain whole turns. The angular velocity does.
  const double whole =
      2 * std::numbers::pi * std::round((spin.dot(turn.axis()) * step - turn.angle()) / (2 * std::numbers::pi));
  return (turn.angle() + whole) / step * turn.axis();
}

}  // namespace

FreeMotion free_motion(const FreeBody& body, double h) {
  FreeMotion f;
  f.inertia = in_world(body.orientation, body.inertia_kg_m2);
  f.inverse_inertia = f.inertia.inverse();
  const Eigen::Vector3d gained = h * (body.gravity_m_s2 + body.force_N / body.mass_kg) -
                                 std::min(1.0, h * body.linear_damping_1_s) * body.velocity_m_s;
  f.start_m_s = body.velocity_m_s + gained / 2;
  f.mean_m_s = body.velocity_m_s + gained;
  f.start_rad_s = body.spin_rad_s;
  f.spin_momentum =
      (1 - std::min(1.0, h * body.angular_damping_1_s)) * (f.inertia * body.spin_rad_s) + h * body.moment_N_m;
  const Eigen::Vector3d spin = f.inverse_inertia * f.spin_momentum;
  const bool even = spin.norm() * h < kHardlyTurns_rad || is_even(body.inertia_kg_m2);
  f.mean_rad_s = even ? spin : mean_spin(body, f.spin_momentum, spin, h);
  return f;
}

void complete_step(FreeBody& body, const FreeMotion& f, const Eigen::Vector3d& mean_m_s,
                   const Eigen::Vector3d& mean_rad_s, const Eigen::Vector3d& offset_m,
                   const Eigen::Vector3d& offset_rad, const Blow& blow, double h) {
  const Eigen::Vector3d momentum = f.spin_momentum + f.inertia * (mean_rad_s - f.mean_rad_s);
  body.velocity_m_s = mean_m_s;
  body.step_s = h;
  body.centre_m += h * mean_m_s + offset_m;
  if (blow.time_s < 0) {
    // The rotation for which the contacts were solved.
    body.orientation = turned(body.orientation, h * mean_rad_s + offset_rad);
  } else {
    body.orientation = turned(body.orientation, blow.turn_rad);
    const double left = h - blow.time_s;
    const Eigen::Vector3d spin = in_world(body.orientation, body.inertia_kg_m2).inverse() * momentum;
    const bool even = spin.norm() * left < kHardlyTurns_rad || is_even(body.inertia_kg_m2);
    body.orientation = turned(body.orientation, left * (even ? spin : mean_spin(body, momentum, spin, left)));
    body.orientation = turned(body.orientation, offset_rad);
  }
  const Eigen::Matrix3d r = body.orientation.toRotationMatrix();
  body.spin_rad_s = r * (body.inertia_kg_m2.inverse() * (r.transpose() * momentum));
  body.force_N.setZero();
  body.moment_N_m.setZero();
}

void displace(FreeBody& body, const Eigen::Vector3d& by_m, const Eigen::Vector3d& by_rad) {
  body.centre_m += by_m;
  body.orientation = turned(body.orientation, by_rad);
}

Eigen::Vector3d velocity_for(const FreeBody& body, double step_s) {
  if (body.step_s < 0 || body.step_s == step_s) return body.velocity_m_s;
  return body.velocity_m_s + (body.step_s - step_s) / 2 * body.gravity_m_s2;
}

BodyMotion motion_of(const FreeBody& body) {
  BodyMotion m;
  m.position_m = m.centre_m = body.centre_m;
  m.orientation = body.orientation;
  m.velocity_m_s = body.velocity_m_s;
  m.spin_rad_s = body.spin_rad_s;
  m.inverse_mass_1_kg = 1 / body.mass_kg;
  m.inverse_inertia = in_world(body.orientation, body.inertia_kg_m2).inverse();
  return m;
}

}  // namespace tactus::sim::impulse
