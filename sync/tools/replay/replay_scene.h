// Extracts the scene of a log, so that a replay can serve it as the simulation did: a node that joins late, or again,
// requests it. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sync/log/log_index.h"
#include "sync/assets/asset.h"

namespace tactus::sync {

// Returns nothing when the log has no complete scene within the first kMaxSceneBytes of the run.
std::vector<Asset> scene_of(std::span<const std::uint8_t> log, const RecordedRun& run);

// Enough for a scene of the largest size that any node accepts, and the other messages recorded meanwhile.
inline constexpr std::size_t kMaxSceneBytes = 512 << 20;

}  // namespace tactus::sync
