#include "haptic_node/devices/spidar/string_pose.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace tactus::haptic {
namespace {

constexpr int kMaxSteps = 30;
// Damping relative to the diagonal (Marquardt 1963): almost zero at first, since the iteration starts from the
// last pose.
constexpr double kMinDamping = 1e-12, kFirstDamping = 1e-9, kMaxDamping = 1e6;

// Applies a translation and a rotation in units of lever_m, so that both are lengths.
GripPose moved(const GripPose& pose, const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>& by, double lever_m) {
  GripPose out = pose;
  out.position_m += by.head<3>();
  if (by.size() == 6) {
    const Eigen::Vector3d turn = by.tail<3>() / lever_m;
    const double angle = turn.norm();
    if (angle > 0)
      out.orientation =
          (Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) * pose.orientation).normalized();
  }
  return out;
}

}  // namespace

SolvedPose solve_pose(const StringFrame& frame, const PerString& lengths_m, const GripPose& from) {
  using Normal = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
  using Step = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
  const double lever_m = frame.lever_m(), done_m = 1e-3 * frame.encoder_step_m;
  SolvedPose out;
  out.pose = from;
  PerString error = string_lengths(frame, out.pose) - lengths_m;
  double damping = kFirstDamping;
  while (out.steps < kMaxSteps && !out.converged) {
    ++out.steps;
    // A string shortens by the motion of its end along it: the derivative of the lengths is minus the structure
    // matrix.
    const StructureMatrix w = structure_matrix(frame, out.pose);
    const Step slope = w * error;
    const Normal normal = w * w.transpose();
    for (bool better = false; !better;) {
      Normal damped = normal;
      damped.diagonal() += damping * (normal.diagonal().array() + 1e-6).matrix();
      const Step step = damped.ldlt().solve(slope);
      const GripPose next = moved(out.pose, step, lever_m);
      const PerString next_error = string_lengths(frame, next) - lengths_m;
      better = next_error.squaredNorm() <= error.squaredNorm();
      if (better) {
        out.pose = next;
        error = next_error;
        damping = std::max(damping / 10, kMinDamping);
      }
      if (!std::isfinite(step.norm()) || step.norm() < done_m) {
        out.converged = std::isfinite(step.norm());
        break;
      }
      if (!better && (damping *= 10) > kMaxDamping) {
        out.steps = kMaxSteps;
        break;
      }
    }
  }
  out.residual_m = std::sqrt(error.squaredNorm() / static_cast<double>(error.size()));
  return out;
}

}  // namespace tactus::haptic
