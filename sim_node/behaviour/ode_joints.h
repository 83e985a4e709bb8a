// The joints of a world in ODE, with springs and dampers, which ODE lacks.
#pragma once

#include <string>
#include <vector>

#include "sim_node/collision/detectors/ode_handles.h"
#include "sim_node/model/world_def.h"
#include "sim_node/model/state_archive.h"

namespace tactus::sim::ode {

class Joints {
 public:
  Joints(const WorldDef& world, dWorldID ode, const std::vector<dBodyID>& bodies, double erp, double cfm);

  // Adds the torques and forces of springs and dampers to the next step. Real-time safe: yes.
  void apply_passive(double step_s);
  // Sets the motor (constant torque or force up to a speed) or the dry friction of a named joint. Returns false when
  // there is no such joint or axis.
  bool set_motor(const std::string& name, int axis, double effort, double velocity);
  bool set_friction(const std::string& name, int axis, double friction);
  void archive(StateArchive& a);

 private:
  struct Joint {
    dJointID id;
    JointDef def;
    dBodyID child, parent;
    double inertia[2];  // effective inertia about each axis between the two bodies; kg m^2, or kg for a slider
    // Rates and passive forces of the previous step: along the axes; as world vectors for a ball joint.
    Eigen::Vector3d last_rate, last_force;
    bool begun = false;
  };
  static void apply(Joint& joint, double step_s);
  JointAxis* axis_of(const std::string& name, int axis);

  std::vector<Joint> joints_;
};

// Force of a spring and damper at the end of a step, stable for any stiffness: the implicit Euler step of I q'' = -k
// (q - q0) - d q' (Baraff and Witkin 1998, equation 6, for one coordinate).
double passive_force(double position, double rate, double stiffness, double reference, double damping, double inertia,
                     double step_s);

}  // namespace tactus::sim::ode
