// Models and links of a scene: bodies with mass, shapes and visuals, and the pairs that do not collide.
#pragma once

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Appends every link of the model and of its nested models. `world_pose`: pose of the model's parent. `scope`: the
// parent's scoped name followed by "::", or empty.
void add_model(LoadContext& context, const sdf::Element& model, const Eigen::Isometry3d& world_pose,
               const std::string& scope, bool inside_static, int material);

}  // namespace tactus::sim
