// The scene that a log holds, so that a replay can serve it as the simulation did: a sense that joins late, or
// again, asks for it. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sync/log/log_origin.h"
#include "sync/assets/scene_exchange.h"

namespace tactus::sync {

// Empty: the log has no whole scene within its first kMostSceneBytes.
std::vector<Asset> scene_of(std::span<const std::uint8_t> log, const LogOrigin& origin);

// A scene of the largest size that any node takes, and what crossed the bus meanwhile.
inline constexpr std::size_t kMaxSceneBytes = 512 << 20;

}  // namespace tactus::sync
