// How far the rate of a node may change beside other work on the machine.
#pragma once

#include <string>

namespace tactus::cluster {

// A blocked node stops, and a node without a limit runs free: both change the rate by far more. Vision draws with the processor and has
// no real-time priority, so other work changes its rate most.
inline double rate_factor(const std::string& node) { return node == "visual_node" ? 5 : 2; }

}  // namespace tactus::cluster
