// The inputs that a NODE_HEALTH message lists: one line a channel, limited to one datagram, because a node whose report
// cannot be sent counts as dead.
#pragma once

#include <cstddef>
#include <tactus/input_health_t.hpp>
#include <tactus/node_health_t.hpp>

namespace tactus::sync {

// Adds a line. When a channel is received in several ways, the first line stays, with the largest of their losses.
void add_input(node_health_t& m, const input_health_t& input);

// Removes lines from the end until the encoded message has at most this number of bytes, and notes the removal. Add required
// inputs first. A message that is too large without any line stays so.
void fit(node_health_t& m, std::size_t bytes);

}  // namespace tactus::sync
