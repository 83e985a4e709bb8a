// A report of health fits one datagram, however many inputs a node has and however long its note is. Pure.
#pragma once

#include <tactus/node_health_t.hpp>

namespace tactus::sync {

// Leaves out inputs until the report is no larger than channels::kMaxMessageBytes: those that never carried
// anything first, then those that the node began to hear last. The note says how many. A note that is too long
// even so is cut.
void make_fit(node_health_t& health);

}  // namespace tactus::sync
