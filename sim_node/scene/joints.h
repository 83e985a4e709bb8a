// Joints of a model, and their motors.
#pragma once

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Appends the joint, and adds its pair of bodies to those that do not collide. `model_pose` and `scope`: of the model or
// world that contains it. Warns of an unsupported type and of a joint of a
// link with itself, and omits the joint.
void add_joint(LoadContext& context, const sdf::Element& joint, const Eigen::Isometry3d& model_pose,
               const std::string& scope);

}  // namespace tactus::sim
