#include "haptic_node/contact/rigid_proxy.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "haptic_node/contact/direct.h"
#include "haptic_node/contact/rotation_math.h"

namespace tactus::haptic {
namespace {

// Iterations in which the linear condition follows the rotation, and friction follows the pressure. Each squares
// the remaining rotation error; the remaining friction error is corrected in the next tick.
constexpr int kRounds = 4;
constexpr int kSweeps = 6;
constexpr double kSettled_m = 1e-9;
// A point this close to its surface may also carry load, m: all four feet of a table do, although three would
// suffice. Its share decreases with the distance, so that it appears and disappears continuously. Design: one
// fiftieth of the thickness of a hair.
constexpr double kCarries_m = 1e-6;
// Maximum remaining correction of a contact that holds, m: beyond it the contact was carried away and holds at its
// new place (design).
constexpr double kMaxStickError_m = 0.001;

Vector6 generalised_direction(const Eigen::Vector3d& direction, const Eigen::Vector3d& arm, double lever_m) {
  Vector6 v;
  v << direction, arm.cross(direction) / lever_m;
  return v;
}

Eigen::Vector3d tangential(const Eigen::Vector3d& v, const Eigen::Vector3d& normal) {
  return v - v.dot(normal) * normal;
}

}  // namespace

struct RigidProxy::Rows {
  std::array<PoseHalfSpace, kMaxHalfSpaces> region;
  std::array<Eigen::Vector3d, kMaxHalfSpaces> arm;  // where friction acts
  std::size_t size = 0;
};

void RigidProxy::reset(const DevicePose& at) {
  pose_ = at;
  velocity_.setZero();
  spin_.setZero();
  moved_m_ = 0;
  binding_.clear();
  feasible_ = true;
}

// Linearises about the current pose of the proxy. start: its pose when the surfaces were placed.
void RigidProxy::linearise(std::span<const Surface> surfaces, const DevicePose& start, Rows& rows) const {
  rows.size = std::min(surfaces.size(), kMaxHalfSpaces);
  for (std::size_t i = 0; i < rows.size; ++i) {
    const Surface& s = surfaces[i];
    rows.arm[i] = arm(s);
    rows.region[i].normal = generalised_direction(s.normal, rows.arm[i], lever_m_);
    rows.region[i].offset = s.offset_m + s.normal.dot(start.orientation * s.tool_point) -
                            s.normal.dot(pose_.position + pose_.orientation * s.tool_point);
  }
}

// Sets the depths: distributes the total pressure over all points that carry load. Sets the binding set, which may
// be larger than the one of the programme.
void RigidProxy::set_depths(std::span<Surface> surfaces, const Rows& rows, const Vector6& goal,
                            ClosestPose& closest) {
  const std::span region(rows.region.data(), rows.size);
  std::array<double, kMaxHalfSpaces> weights{};
  std::size_t carry = 0;
  for (std::size_t i = 0; i < rows.size && closest.feasible; ++i) {
    const double height = rows.region[i].normal.dot(closest.pose) - rows.region[i].offset;
    const double share = std::clamp(1 - height / kCarries_m, 0.0, 1.0);
    weights[i] = share * share;
    carry += weights[i] > 0;
  }
  if (carry > closest.binding.size() || carry > 1)
    if (distribute(region, weights, closest.pose - goal, closest.multiplier)) {
      closest.binding = {};
      for (std::size_t i = 0; i < rows.size; ++i)
        if (closest.multiplier[i] > 0) closest.binding.add(i, region[i].normal);
    }
  for (std::size_t i = 0; i < rows.size; ++i) surfaces[i].depth_m = closest.multiplier[i];
}

// Shared as the depths in direct rendering: contacts that press in the same direction damp together as one, and a
// contact that begins to press begins at zero. The binding set is not used: for nearly dependent contacts it would
// give large rates of both signs, and a surface does not pull.
void RigidProxy::depth_rates(std::span<const Surface> surfaces, const Eigen::Vector3d& velocity,
                             const Eigen::Vector3d& spin, std::span<double> rates) const {
  std::array<Vector6, kMaxHalfSpaces> direction;
  const std::size_t n = std::min({surfaces.size(), rates.size(), kMaxHalfSpaces});
  for (std::size_t i = 0; i < n; ++i)
    if (surfaces[i].depth_m > 0)
      direction[i] = generalised_direction(surfaces[i].normal, arm(surfaces[i]), lever_m_);
  for (std::size_t i = 0; i < n; ++i) {
    const Surface& s = surfaces[i];
    rates[i] = 0;
    if (s.depth_m <= 0) continue;
    double coupled_m = 0;
    for (std::size_t j = 0; j < n; ++j)
      if (surfaces[j].depth_m > 0) coupled_m += surfaces[j].depth_m * std::abs(direction[i].dot(direction[j]));
    rates[i] = s.depth_m / coupled_m * (s.velocity_at(s.point) - velocity - spin.cross(arm(s))).dot(s.normal);
  }
}

// Friction of each pressed contact, towards the place where it held, within its cone. Contacts are solved one
// after another, each with the results of the others and in the directions that the binding surfaces leave free
// (Gauss and Seidel).
void RigidProxy::solve_friction(std::span<Surface> surfaces, const DevicePose& start, const Rows& rows,
                                const ClosestPose& closest, double dt) {
  Vector6 motion = closest.pose;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double changed = 0;
    for (std::size_t i = 0; i < rows.size; ++i) {
      Surface& s = surfaces[i];
      if (s.depth_m <= 0) {
        s.grip.setZero();
        s.slipping = false;
        continue;
      }
      const Eigen::Vector3d u = s.normal.unitOrthogonal(), v = s.normal.cross(u);
      const Vector6 along_u = generalised_direction(u, rows.arm[i], lever_m_),
                    along_v = generalised_direction(v, rows.arm[i], lever_m_);
      const Vector6 free_u = closest.binding.free_part(along_u), free_v = closest.binding.free_part(along_v);
      // Current place of the tool point, relative to its previous place as carried by the surface.
      const Eigen::Vector3d on_tool = pose_.orientation * s.tool_point - start.orientation * s.tool_point;
      const Eigen::Vector3d base = pose_.position - start.position + on_tool + s.stick_error -
                                   dt * s.velocity_at(start.position + start.orientation * s.tool_point);
      const Eigen::Vector2d slid(base.dot(u) + along_u.dot(motion), base.dot(v) + along_v.dot(motion));
      Eigen::Matrix2d answer;
      answer << along_u.dot(free_u), along_u.dot(free_v), along_v.dot(free_u), along_v.dot(free_v);
      // A contact that the other contacts leave no freedom has no friction force.
      constexpr double kStiff = 1e-3;
      answer.diagonal().array() += kStiff;
      const Eigen::Vector2d had(s.grip.dot(u), s.grip.dot(v));
      Eigen::Vector2d wanted = had - answer.inverse() * slid;
      const double widest = s.depth_m * (s.slipping ? s.friction_dynamic : s.friction_static);
      s.slipping = wanted.norm() > widest;
      if (s.slipping) wanted *= s.depth_m * s.friction_dynamic / wanted.norm();
      const Eigen::Vector2d by = wanted - had;
      s.grip = wanted.x() * u + wanted.y() * v;
      motion += by.x() * free_u + by.y() * free_v;
      changed = std::max(changed, by.norm());
    }
    if (changed < kSettled_m) break;
  }
}

// Applies a motion as far as may_move_m allows. Returns the upper bound of the distance of a tool point from its
// start, m.
double RigidProxy::move(const DevicePose& start, const Vector6& motion, double may_move_m) {
  const DevicePose from = pose_;
  const auto moved_by = [&](double share) {
    pose_.position = from.position + share * motion.head<3>();
    pose_.orientation = rotated_by(share / lever_m_ * motion.tail<3>(), from.orientation);
    return (pose_.position - start.position).norm() +
           bound_m_ * rotation_between(start.orientation, pose_.orientation).norm();
  };
  double moved = moved_by(1);
  constexpr int kHalvings = 12;
  double low = 0, high = 1;
  if (moved <= may_move_m) return moved;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (moved_by(middle) <= may_move_m ? low : high) = middle;
  }
  return moved_by(low);
}

void RigidProxy::step(std::span<Surface> surfaces, const DevicePose& device, double dt, double may_move_m) {
  const DevicePose start = pose_;
  Rows rows;
  ClosestPose closest;
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    surfaces[i].grip = tangential(surfaces[i].grip, surfaces[i].normal);
  for (int round = 0; round < kRounds; ++round) {
    linearise(surfaces, start, rows);
    Vector6 goal;
    goal << device.position - pose_.position, lever_m_ * rotation_between(pose_.orientation, device.orientation);
    const auto solve = [&] {
      Vector6 held = goal;
      for (std::size_t i = 0; i < rows.size; ++i)
        if (!surfaces[i].grip.isZero(0)) held += generalised_direction(surfaces[i].grip, rows.arm[i], lever_m_);
      closest = closest_pose({rows.region.data(), rows.size}, held);
      set_depths(surfaces, rows, held, closest);
    };
    solve();
    if (!closest.feasible) break;
    solve_friction(surfaces, start, rows, closest, dt);
    solve();
    if (!closest.feasible) break;
    moved_m_ = move(start, closest.pose, may_move_m);
    if (closest.pose.norm() < kSettled_m || moved_m_ >= 0.999 * may_move_m) break;
  }
  feasible_ = closest.feasible;
  binding_ = closest.binding;
  if (!feasible_) {
    // Between walls that leave no room each wall yields, and the depth of the device itself under each is
    // rendered.
    moved_m_ = move(start, closest.pose, may_move_m);
    const DevicePose here = pose_;
    compute_direct_depths(surfaces, start, device, lever_m_, tool_radius_m_);
    pose_ = here;
  }
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    Surface& s = surfaces[i];
    const bool holds = feasible_ && s.depth_m > 0 && !s.slipping;
    if (!holds) {
      s.stick_error.setZero();
      if (s.depth_m <= 0 || !feasible_) s.grip.setZero();
      continue;
    }
    const Eigen::Vector3d before = start.position + start.orientation * s.tool_point;
    s.stick_error += pose_.position + pose_.orientation * s.tool_point - before - dt * s.velocity_at(before);
    s.stick_error = tangential(s.stick_error, s.normal);
    if (s.stick_error.norm() > kMaxStickError_m) s.stick_error.setZero();
  }
  velocity_ = dt > 0 ? Eigen::Vector3d((pose_.position - start.position) / dt) : Eigen::Vector3d::Zero();
  spin_ = dt > 0 ? Eigen::Vector3d(rotation_between(start.orientation, pose_.orientation) / dt)
                 : Eigen::Vector3d::Zero();
}

}  // namespace tactus::haptic
