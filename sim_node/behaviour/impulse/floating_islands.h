// Angular momentum of bodies that a correction of positions has moved. A displacement at unchanged velocities changes the
// angular momentum of a group of bodies that touch each other only. A small common rotation rate restores it; linear
// momentum and relative velocities at their contacts do not change.
#pragma once

#include <span>
#include <vector>

#include "sim_node/behaviour/impulse/contact_rows.h"

namespace tactus::sim::impulse {

class FloatingIslands {
 public:
  // A displaced body. World axes.
  struct Body {
    double mass_kg = 0;
    Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Zero();
    Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d lost_kg_m2_s = Eigen::Vector3d::Zero();  // angular momentum that the displacement took
    Eigen::Vector3d *velocity_m_s = nullptr, *spin_rad_s = nullptr;  // get the common rotation rate
  };

  struct Member {
    int root = 0, twist = 0;  // of its group; its own index of a twist
  };

  // Finds the groups of free bodies that corrections have pushed apart, without those near a static body or a link.
  // pushed: correction of each point of the rows; 0: none. Deterministic. Real-time safe once its lists have grown.
  void find(const ContactRows& rows, std::span<const double> pushed);
  // Their bodies.
  std::span<const Member> members() const { return members_; }
  // Calls describe(twist index), which returns a Body, for each body of each group, and corrects the velocities.
  template <class Describe>
  void restore_spin(Describe describe) {
    for (std::size_t begin = 0; begin < members_.size();) {
      island_.clear();
      const int root = members_[begin].root;
      for (; begin < members_.size() && members_[begin].root == root; ++begin) island_.push_back(describe(members_[begin].twist));
      restore_spin();
    }
  }

 private:
  int root(int twist);
  void restore_spin();

  std::vector<int> root_;        // per twist
  std::vector<Member> members_;  // ordered by root, then by twist
  std::vector<Body> island_;
};

}  // namespace tactus::sim::impulse
