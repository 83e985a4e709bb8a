// The joints of a world in ODE, and the springs and dampers in them, which ODE does not have.
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

  // Adds the torques and forces of springs and dampers for the next step. Realtime-safe: yes.
  void apply_passive(double step_s);
  // Of a joint with axes, by its name: a constant torque or force up to a speed, and dry friction. False: there is no such
  // joint or axis.
  bool set_motor(const std::string& name, int axis, double effort, double velocity);
  bool set_friction(const std::string& name, int axis, double friction);
  void archive(StateArchive& a);

  // Largest distance between the two images of an anchor, m: how far the joints have come apart.
  double largest_gap_m() const;

 private:
  struct Joint {
    dJointID id;
    JointDef def;
    dBodyID child, parent;
    double inertia[2];  // about each axis, of the two bodies against each other; kg m^2, or kg for a slider
    // Rates and passive forces of the step before: along the axes, or of a ball joint as vectors of the world.
    Eigen::Vector3d last_rate, last_force;
    bool begun = false;
  };
  static void apply(Joint& joint, double step_s);
  JointAxis* axis_of(const std::string& name, int axis);

  std::vector<Joint> joints_;
};

// Force of a spring and damper at the end of a step, so that it cannot explode however stiff it is: the implicit Euler
// step of I q'' = -k (q - q0) - d q' (Baraff and Witkin 1998, equation 6, for one coordinate).
double passive_force(double position, double rate, double stiffness, double reference, double damping, double inertia,
                     double step_s);

}  // namespace tactus::sim::ode
