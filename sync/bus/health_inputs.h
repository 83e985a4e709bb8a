// The inputs that a node's health lists: one line a channel, and no more than fit into a datagram, since a report that
// cannot be sent is that of a node that is dead to the others.
#pragma once

#include <cstddef>
#include <tactus/input_health_t.hpp>
#include <tactus/node_health_t.hpp>

namespace tactus::sync {

// Adds a line; of a channel that is heard in several ways the first stays, with the worst of their losses.
void add_input(node_health_t& m, const input_health_t& input);

// Leaves out lines from the last on until the message has at most so many bytes encoded, and says so in its note.
// What a node cannot do without should be added first. Without any line a message that is still too large stays so.
void fit(node_health_t& m, std::size_t bytes);

}  // namespace tactus::sync
