// Node settings of a scene: <tactus:audio_node presentation_delay="20ms"/> inside <world>.
#pragma once

#include <string_view>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// "tactus:SOMETHING_node": settings of a node, of this project or of another one.
bool is_setting_element(std::string_view name);

// Rejects a setting that the node does not have or that is out of range. Warns of a node that this build does not
// include, such as a sixth modality, and passes its settings on unchecked.
void read_settings(LoadContext& context, const sdf::Element& world);

}  // namespace tactus::sim
