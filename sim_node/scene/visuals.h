// Visuals of a link: their shapes and their appearance.
#pragma once

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Appends the visuals of the link: one each, and for a mesh file with several materials one per material. Colours and
// pictures come from SDF, else from the mesh file. Warns of a script with an unknown colour, of a missing picture
// that a mesh file names, and of a missing mesh file, for which a magenta box of 10 cm stands (LoadContext::placeholders).
void add_visuals(LoadContext& context, const sdf::Element& link, int body, int material);

}  // namespace tactus::sim
