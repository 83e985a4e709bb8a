// Models and links: bodies with their mass, shapes and visuals, and who may collide with whom.
#pragma once

#include <sdf/Model.hh>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Appends every link of the model and of the models nested in it. `world_pose` is the pose of the model's parent,
// `scope` its scoped name with "::" after it, or empty.
void add_model(LoadContext& context, const sdf::Model& model, const Eigen::Isometry3d& world_pose,
               const std::string& scope, bool inside_static, int material);

}  // namespace tactus::sim
