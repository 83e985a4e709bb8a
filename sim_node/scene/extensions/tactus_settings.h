// The options of the nodes that a scene sets: <tactus:audio_node presentation_delay="20ms"/> inside <world>.
#pragma once

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// "tactus:SOMETHING_node": the options of a node, of this project or of another.
bool is_setting_element(const std::string& name);

// Refuses a setting that its node does not have or that is out of range. Warns of a node that this build does not know
// (a sixth sense may live elsewhere) and passes its settings on as they are.
void read_settings(LoadContext& context, const sdf::ElementPtr& world);

}  // namespace tactus::sim
