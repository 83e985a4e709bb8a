// The message types as text, so that a log can be read without the Tactus version that wrote it. Pure.
//
// On the channel LOG_TYPES, in pages of at most one datagram, plain UTF-8 without a header or fingerprint:
//
//   tactus types, page 1 of 9
//   channel WORLD_STATE world_state_t
//   struct world_state_t 0x7697da36a53a86f6     (the 8 bytes that its messages begin with)
//     header_t header
//     body_state_t bodies[count]
//     body_state_t bodies[count]
#pragma once

#include <string>
#include <vector>

namespace tactus::sync {

inline constexpr const char* kLogTypes = "LOG_TYPES";

// Returns the pages in order. No line is split between pages; the text is the pages without the first line of
// each.
std::vector<std::string> log_types();

}  // namespace tactus::sync
