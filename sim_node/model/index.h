// Numbers of bodies, shapes and units as indices of a vector.
#pragma once

#include <cstddef>

namespace tactus::sim {

// i >= 0, as an index. Thread-safe, real-time safe.
constexpr std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace tactus::sim
