// A joint that starts outside its limits returns to the nearer one, and keeps no speed from that.
#include <catch2/catch.hpp>

#include "sim_node/behaviour/solver.h"
#include "tests/sim_node/support/small_worlds.h"
#include "tests/sim_node/support/solver_steps.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

TEST_CASE("A slider that starts outside its limits returns to the nearer one without a speed that remains") {
  const double lower = GENERATE(0.01, 0.5);
  const bool above = GENERATE(false, true);
  WorldDef w = empty_world(0);
  const int moving = add_body(w, "slider", 1, Eigen::Matrix3d::Identity() * 0.01, at(0, 0, 0));
  JointDef& joint = add_joint(w, JointKind::kPrismatic, -1, moving, {0, 0, 0}, {0, 0, 1});
  joint.axes[0].lower = above ? -2 * lower : lower;
  joint.axes[0].upper = above ? -lower : 2 * lower;
  Solver s(w, {});
  double fastest = 0;
  for (int i = 0; i < 4000; ++i) {
    s.step();
    fastest = std::max(fastest, body(s, moving).velocity_m_s.norm());
  }
  CAPTURE(lower, above);
  CHECK(fastest <= std::max(0.021, 1.01 * lower / 0.5));  // half a second to go two thirds of the way
  CHECK(body(s, moving).centre_m.z() == Approx(above ? -lower : lower).margin(1e-4));
  CHECK(body(s, moving).velocity_m_s.norm() < 1e-6);
}
