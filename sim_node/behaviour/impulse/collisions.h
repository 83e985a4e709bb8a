// Collisions before contact (Guendelman, Bridson and Fedkiw 2003, "Nonconvex rigid bodies with stacking", section
// 5): pairs rebound one after the other, the fastest approach first, until none approaches. Simultaneous equations
// would share a blow among all that touch; in sequence it travels, as through Newton's cradle.
#pragma once

#include <vector>

#include "sim_node/behaviour/impulse/contact_rows.h"

namespace tactus::sim::impulse {

class Collisions {
 public:
  struct Limits {
    double bounce_speed_m_s = 0.02;  // what is slower, beyond what a step adds, is left to the contact solver
    double touching_m = 1e-4;        // points this near to the first that meets collide with it
  };
  explicit Collisions(Limits limits) : limits_(limits) {}

  // velocity: at the start of the step, changed by the blows. aside: by how much each collision at an instant t
  // inside the step sets free bodies aside, -t times their change of velocity (m, rad): moved from the start of
  // the step with the new velocity and this offset, they lie on the path that turns at t. An overlap that came
  // about in the last step is such an instant before the start. first_rate: of each system, and one past the last.
  // Realtime-safe once its lists have grown.
  // Each group is told how it meets. Without restitution a pair of free bodies takes one blow, so that it stops where and
  // when it met; what follows is left to the contact solver, and all of it where joints are struck.
  void resolve(ContactRows& rows, double h_s, const std::vector<std::size_t>& first_rate, Velocities& velocity,
               Velocities& aside);

 private:
  struct Meeting {
    double time_s = 0, speed_m_s = 0;
  };
  bool meets(const ContactPoint& p, Meeting& out) const;
  bool collides(const ContactPoint& p, Meeting& out) const;
  double approach(const ContactGroup& g) const;
  void rebound(ContactGroup& g);
  void foresee(ContactGroup& g) const;
  template <class F>
  void of_mover(int mover, F&& each);

  Limits limits_;
  ContactRows* rows_ = nullptr;
  const std::vector<std::size_t>* first_rate_ = nullptr;
  Velocities *velocity_ = nullptr, *aside_ = nullptr;
  double h_ = 0;
  std::vector<double> approach_;  // per group
  std::vector<double> before_;    // velocities of the two movers
};

}  // namespace tactus::sim::impulse
