#include "sim_node/behaviour/impulse/contact_rows.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <utility>

namespace tactus::sim::impulse {
namespace {

// Jamming (Painleve): friction rotates the surface into the other one, which nearly cancels or reverses the effect of
// the normal impulse. Below this share of the effect the direction of sliding is searched for.
constexpr double kWedged = 0.2;
constexpr int kDirections = 48, kBisections = 40;

// Searches the edge of the friction cone in all directions for an impulse at which friction opposes the remaining
// sliding and the surfaces do not separate. start: velocity without an impulse.
Eigen::Vector3d solve_wedged(const ContactPoint& p, const Eigen::Vector3d& start) {
  const auto at = [&](double angle, Eigen::Vector3d& impulse) {
    const Eigen::Vector3d ray(1, p.friction * std::cos(angle), p.friction * std::sin(angle));
    const double moved = p.mobility.row(0).dot(ray);
    impulse =
        moved > 1e-6 * p.mobility(0, 0) ? Eigen::Vector3d(-start.x() / moved * ray) : Eigen::Vector3d(0, 0, 0);
    const Eigen::Vector3d v = start + p.mobility * impulse;
    // Returns the component of the sliding velocity across the friction, and whether friction opposes it.
    return std::pair(v.z() * std::cos(angle) - v.y() * std::sin(angle),
                     moved > 1e-6 * p.mobility(0, 0) && v.y() * std::cos(angle) + v.z() * std::sin(angle) <= 0);
  };
  Eigen::Vector3d impulse;
  const double part = 2 * std::numbers::pi / kDirections;
  for (int i = 0; i < kDirections; ++i) {
    double low = i * part, high = low + part;
    auto [crossing, opposed] = at(low, impulse);
    const auto [beyond, opposed_beyond] = at(high, impulse);
    if ((crossing > 0) == (beyond > 0) || !(opposed || opposed_beyond)) continue;
    for (int k = 0; k < kBisections; ++k) {
      const double middle = (low + high) / 2;
      ((at(middle, impulse).first > 0) == (crossing > 0) ? low : high) = middle;
    }
    if (at(low, impulse).second) return impulse;
  }
  return {-start.x() / p.mobility(0, 0), 0, 0};
}

}  // namespace

void ContactRows::clear() {
  points.clear();
  groups.clear();
  couplings.clear();
  pool.clear();
}

double ContactRows::path_bend_m(const ContactPoint& p, const Velocities& v, double h) const {
  const Eigen::Vector3d n = p.axes.row(0);
  const auto towards_centre = [&](int twist, const Eigen::Vector3d& arm) {
    if (!twist) return 0.0;
    const Eigen::Vector3d& w = v.twists[static_cast<std::size_t>(twist)].angular_rad_s;
    return w.dot(arm) * w.dot(n) - arm.dot(n) * w.squaredNorm();
  };
  return h * h / 2 * (towards_centre(p.b, p.arm_b) - towards_centre(p.a, p.arm_a));
}

void ContactRows::add_velocity(const ContactPoint& p, const Velocities& v, Eigen::Vector3d& out) const {
  for (int c = 0; c < p.couplings; ++c) {
    const Coupling& k = couplings[static_cast<std::size_t>(p.first_coupling + c)];
    const double *j = pool.data() + k.jacobian, *rate = v.rates.data() + k.first_rate;
    for (int r = 0; r < 3; ++r, j += k.rates) {
      double sum = 0;
      for (std::size_t i = 0; i < k.rates; ++i) sum += j[i] * rate[i];
      out[r] += sum;
    }
  }
}

void ContactRows::apply_to_joints(const ContactPoint& p, const Eigen::Vector3d& impulse, Velocities& v) const {
  for (int c = 0; c < p.couplings; ++c) {
    const Coupling& k = couplings[static_cast<std::size_t>(p.first_coupling + c)];
    const double* response = pool.data() + k.response;
    double* rate = v.rates.data() + k.first_rate;
    for (int r = 0; r < 3; ++r, response += k.rates)
      for (std::size_t i = 0; i < k.rates; ++i) rate[i] += response[i] * impulse[r];
  }
}

void ContactRows::compute_mobility(ContactPoint& p) const {
  Eigen::Matrix3d k = Eigen::Matrix3d::Zero();
  const auto add = [&](int twist, const Eigen::Vector3d& arm) {
    if (!twist) return;
    const InverseInertia& m = inertias[static_cast<std::size_t>(twist)];
    Eigen::Matrix3d turn;  // columns: arm x axis
    for (int i = 0; i < 3; ++i) turn.col(i) = arm.cross(Eigen::Vector3d(p.axes.row(i)));
    k.noalias() += turn.transpose() * (m.inverse_inertia * turn);
    k.diagonal().array() += m.inverse_mass_1_kg;
  };
  add(p.a, p.arm_a);
  add(p.b, p.arm_b);
  for (int c = 0; c < p.couplings; ++c) {
    const Coupling& q = couplings[static_cast<std::size_t>(p.first_coupling + c)];
    using Rows = Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>>;
    const auto n = static_cast<Eigen::Index>(q.rates);
    const Rows jacobian(pool.data() + q.jacobian, 3, n), response(pool.data() + q.response, 3, n);
    k.noalias() += jacobian.lazyProduct(response.transpose());
  }
  // Joints may leave no mobility along an axis. It is set to a billionth of the rest, so that the matrix is
  // invertible; the impulse along it has no effect.
  k.diagonal().array() += 1e-9 * k.trace();
  p.mobility = k;
  p.inverse_mobility = k.inverse();
  const double mean = (k(1, 1) + k(2, 2)) / 2, off = std::hypot((k(1, 1) - k(2, 2)) / 2, k(1, 2));
  p.sliding_mobility = mean + off;
}

Eigen::Vector3d ContactRows::solve_sliding(const ContactPoint& p, const Eigen::Vector3d& impulse,
                                           const Eigen::Vector3d& v, double alone) {
  const double y = impulse.y() - v.y() / p.sliding_mobility, z = impulse.z() - v.z() / p.sliding_mobility;
  const double size = std::sqrt(y * y + z * z);
  if (size == 0) return {-alone / p.mobility(0, 0), 0, 0};
  const double slope_y = p.friction * y / size, slope_z = p.friction * z / size;
  const double wedged = p.mobility(0, 0) + p.mobility(0, 1) * slope_y + p.mobility(0, 2) * slope_z;
  if (wedged < kWedged * p.mobility(0, 0)) return solve_wedged(p, v - p.mobility * impulse);
  const double normal = -alone / wedged;
  return {normal, normal * slope_y, normal * slope_z};
}

}  // namespace tactus::sim::impulse
