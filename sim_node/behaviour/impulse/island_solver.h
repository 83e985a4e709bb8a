// Second stage of the contact solver, for islands of contacts that the sweeps left unconverged: heavy bodies on light
// ones, wedged bodies, towers. Small islands are solved as a whole by a semismooth Newton method (Alart and Curnier
// 1991, "A mixed formulation for frictional contact problems prone to Newton like solution methods"). Every island is
// then checked: impulses that add kinetic energy are scaled back.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "sim_node/behaviour/impulse/contact_rows.h"
#include "sim_node/behaviour/impulse/joint_rows.h"

namespace tactus::sim::impulse {

class IslandSolver {
 public:
  struct Result {
    double residual_m_s = 0;  // largest change that another sweep would make
    int unconverged = 0;      // islands that another sweep would change by more than settled_m_s
    int limited = 0;          // islands whose impulses were scaled back
  };

  // Improves the impulses of the rows and the velocities. before: velocities without them. movers: number of mover
  // indices. Linear and angular momentum between bodies do not change, since impulses act on both sides at one point,
  // and scaling keeps that. Deterministic. Real-time safe once its lists have grown.
  Result refine(ContactRows& rows, std::span<const JointRow> joints, int movers, double settled_m_s,
                const Velocities& before, Velocities& velocity);

 private:
  using Vector3d = Eigen::Vector3d;
  struct Island {
    int first = 0, count = 0;  // in points_
    bool has_joints = false;
  };
  int root(int mover);
  void find_islands(const ContactRows& rows, std::span<const JointRow> joints, int movers);
  std::span<const int> points_of(const Island& island) const {
    return {points_.data() + island.first, static_cast<std::size_t>(island.count)};
  }
  double residual_m_s(const ContactRows& rows, std::span<const int> points, const Velocities& velocity) const;
  bool solve(ContactRows& rows, std::span<const int> points, double settled_m_s, Velocities& velocity);
  void build(const ContactRows& rows, std::span<const int> points, const Velocities& velocity);
  double residual_of(const ContactRows& rows, std::span<const int> points, const std::vector<double>& impulse);
  void linearise(const ContactRows& rows, std::span<const int> points);
  bool eliminate();
  bool limit_energy(ContactRows& rows, std::span<const int> points, const Velocities& before, Velocities& velocity);

  std::vector<int> root_, island_of_, points_;
  std::vector<Island> islands_;
  // One island, 3 rows a point, row-major: velocity = matrix_ * impulse + free_.
  std::size_t n_ = 0;
  std::vector<double> matrix_, free_, speed_, impulse_, best_, trial_, step_, jacobian_;
  std::vector<std::pair<std::size_t, std::size_t>> filled_;  // of each row of matrix_: its first column that is not zero, and one past the last
  std::vector<std::size_t> end_;  // of each row of jacobian_: one past its last column that is not zero
  Velocities unit_;
};

}  // namespace tactus::sim::impulse
