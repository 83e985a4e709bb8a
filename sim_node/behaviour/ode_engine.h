// ODE objects of Solver, for its own source files only.
#pragma once

#include <memory>
#include <vector>

#include "sim_node/collision/detectors/ode_handles.h"
#include "sim_node/behaviour/ode_joints.h"
#include "sim_node/behaviour/solver.h"
#include "sim_node/collision/detectors/ode_shapes.h"

namespace tactus::sim {

// Maximum number of contact points per step, and storage for their feedback, which must outlive the step.
inline constexpr std::size_t kMaxPoints = 16384;

struct Solver::Engine {
  ode::Library library;
  ode::Owned<dWorldID> world;
  dJointGroupID contact_joints;
  std::vector<dBodyID> bodies;  // null: static
  std::vector<bool> jointed;
  std::unique_ptr<ode::Joints> joints;
  std::unique_ptr<ode::Shapes> shapes;
  struct JointPoint {
    ManifoldPoint* point;
    bool first_is_b;
  };
  std::vector<JointPoint> joint_points;
  std::vector<dJointFeedback> feedback;
  bool exact = false;

  Engine() : world(dWorldCreate()), contact_joints(dJointGroupCreate(0)) {}
  ~Engine() {
    joints.reset();
    shapes.reset();
    dJointGroupDestroy(contact_joints);
  }

  static void archive(StateArchive& a, dBodyID id);
  // Returns null for a static body. Throws std::runtime_error with one sentence.
  dBodyID make_body(const BodyDef& def, const Eigen::Vector3d& gravity_m_s2, double step_s);
};

}  // namespace tactus::sim
