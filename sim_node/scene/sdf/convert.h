// Elements of SDFormat 1.4 to 1.8 as those of 1.9, and the checks of names.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "sim_node/scene/sdf/element.h"

namespace tactus::sim::sdf {

// Changes an element that has all its children: <gravity> inside <physics> (until 1.5), frame of <pose> (until 1.6),
// use_parent_model_frame (until 1.6; the default of 1.4). By the version of its file.
void convert(Element& element);

// Checks the names inside a <world> or <model>: each has one, none is reserved, and none occurs twice. Until 1.6, a link, a
// joint and a frame could have the same name; they are renamed as libsdformat does, with a warning. strings: of the new
// names.
void check_names(Element& element, std::deque<std::string>& strings, std::vector<std::string>& warnings);

}  // namespace tactus::sim::sdf
