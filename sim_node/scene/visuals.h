// Visuals of a link: their shapes and their appearance.
#pragma once

#include <sdf/Link.hh>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Appends the visuals of the link: one each, and for a mesh file with several materials one per material. Colours and
// pictures come from SDF, else from the mesh file. Warns of a script with an unknown colour and of a missing picture
// that a mesh file names.
void add_visuals(LoadContext& context, const sdf::Link& link, int body, int material);

}  // namespace tactus::sim
