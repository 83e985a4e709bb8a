// Type of a contact: point, edge or surface.
#pragma once

#include <cstdint>

namespace tactus::sim {

// Values of contact_t::kind.
enum class ContactKind : std::int8_t { kPoint = 0, kEdge = 1, kSurface = 2 };

}  // namespace tactus::sim
