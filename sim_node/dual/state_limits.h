// Limits of a stored state of two groups: a state that exceeds them is rejected.
#pragma once

#include <cstddef>

namespace tactus::sim {

inline constexpr std::size_t kMaxStoredContacts = 1 << 16;  // as of ContactTracker
inline constexpr std::size_t kMaxStoredPairs = 1 << 18;     // of touching bodies
inline constexpr std::size_t kMaxStoredChanges = 1 << 12;   // of the scene, within one visual step

}  // namespace tactus::sim
