// Joints of a model, and the motors on them.
#pragma once

#include <sdf/Joint.hh>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Appends the joint, and the pair of its bodies to those that do not collide. `model_pose` and `scope` are those of the
// model that it stands in. Warns of a type that is not supported, and leaves the joint out.
void add_joint(LoadContext& context, const sdf::Joint& joint, const Eigen::Isometry3d& model_pose,
               const std::string& scope);

}  // namespace tactus::sim
