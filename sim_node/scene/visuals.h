// What is seen of a link: the shapes of its visuals and how each is drawn.
#pragma once

#include <sdf/Link.hh>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Appends the link's visuals: one for each, and of a mesh whose file has several materials one for each of those. Colours and
// pictures are those that SDF says, then those of the mesh file. Warns of a script whose colour is not known and of a picture
// that a mesh file names and that is not to be had.
void add_visuals(LoadContext& context, const sdf::Link& link, int body, int material);

}  // namespace tactus::sim
