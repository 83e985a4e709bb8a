// Collisions before contact (Guendelman, Bridson and Fedkiw 2003, "Nonconvex rigid bodies with stacking", section 5):
// pairs rebound one after the other, in the order of their times, until none approaches. A simultaneous solution would
// divide an impulse among all touching bodies; a sequential one propagates it, as in Newton's cradle.
#pragma once

#include <array>
#include <vector>

#include "sim_node/behaviour/impulse/contact_rows.h"
#include "sim_node/behaviour/impulse/free_body.h"
#include "sim_node/model/manifold.h"

namespace tactus::sim::impulse {

class Collisions {
 public:
  struct Limits {
    double bounce_speed_m_s = 0.02;  // slower impacts, beyond what a step adds, are left to the contact solver
    double touching_m = 1e-4;        // points whose gap is within this of the first collide together with it
    double shell_m = 0;              // gap of the surfaces at which they meet
  };
  explicit Collisions(Limits limits) : limits_(limits) {}

  // drift: of the velocity, from the start of the step to its mean.
  // velocity: at the start of the step, changed by the impulses. aside: position offset of free bodies, m and rad. A
  // collision at a time t inside the step adds -t times the change of velocity: a body that moves from the start of
  // the step with the new velocity and this offset follows the path with the impulse at t. An overlap from the last
  // step is a collision at a time before the start. first_rate: of each system, and one past the last. Real-time safe
  // once its lists have grown. Sets the impact data of each group. Without restitution a pair of free bodies takes
  // one impulse on each face, so that it stops where and when it met. The contact solver handles the rest, and all impacts on
  // joints without restitution.
  void resolve(ContactRows& rows, double h_s, const std::vector<std::size_t>& first_rate, const Velocities& drift,
               Velocities& velocity, Velocities& position_offset);

  // Before resolve(): clears the impacts of a free body. The cost of a step depends on the bodies that take part only.
  void begin_step(std::size_t twist) {
    if (blows_.size() <= twist) blows_.resize(twist + 1);
    blows_[twist] = {};
  }
  // The last impact of a free body (index of its twist) in the step, and its rotation offset by all impacts, rad.
  const Blow& blow_of(std::size_t twist) const { return blows_[twist].last; }
  const Eigen::Vector3d& offset_rad(std::size_t twist) const { return blows_[twist].offset_rad; }

 private:
  struct PredictedImpact {
    double time_s = 0, speed_m_s = 0;
  };
  bool will_touch(const ContactPoint& p, PredictedImpact& out) const;
  bool will_collide(const ContactPoint& p, PredictedImpact& out) const;
  PredictedImpact approach(const ContactGroup& g) const;
  int next_impact() const;
  void move_to(ContactGroup& g, double time_s);
  void move_back(ContactGroup& g, double time_s);
  using PointImpulses = std::array<Eigen::Vector3d, kMaxManifoldPoints>;
  void apply_collision(ContactGroup& g);
  void solve_impact(const ContactGroup& g, double time_s, const double* wanted, PointImpulses& impulse);
  double passive_share(const ContactGroup& g, double time_s, const PointImpulses& compression, const PointImpulses& restitution);
  void report_impact(ContactGroup& g, double time_s, int struck, const std::array<double, kMaxManifoldPoints>& closing,
                     const PointImpulses& impulse) const;
  void predict_impact(ContactGroup& g) const;
  template <class F>
  void for_each_component(int mover, F&& each);

  struct BodyBlows {
    Blow last;
    Eigen::Vector3d offset_rad = Eigen::Vector3d::Zero();
  };
  // A body of a pair at the time of its impact.
  struct MovedBody {
    int twist = 0;  // 0: static, or a link
    Twist start, struck;  // velocities: of the start of the step, and at the time before the impact
    Eigen::Vector3d shift_m, turn_rad;
    Eigen::Matrix3d rotation, inertia, start_inverse_inertia;
  };

  Limits limits_;
  std::vector<BodyBlows> blows_;  // per twist
  MovedBody moved_[2];
  std::vector<ContactPoint> start_points_;  // of the pair, at the poses of the start
  ContactRows* rows_ = nullptr;
  const std::vector<std::size_t>* first_rate_ = nullptr;
  const Velocities* drift_ = nullptr;
  Velocities *velocity_ = nullptr, *position_offset_ = nullptr;
  double h_ = 0;
  std::vector<PredictedImpact> approach_;  // per group
  std::vector<double> before_;    // velocities of the two movers
  std::array<bool, kMaxManifoldPoints> takes_part_{};  // points of the pair that collide
};

}  // namespace tactus::sim::impulse
