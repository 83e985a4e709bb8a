// The head of a log: its run, and the scene with all its assets, so that a log is complete in itself. Pure.
#pragma once

#include <string>
#include <tactus/asset_ref_t.hpp>
#include <tactus/log_info_t.hpp>
#include <vector>

#include "sync/bus/identity.h"
#include "sync/assets/asset.h"
#include "sync/time/time.h"

namespace tactus::sync {

// Spacing of the head's messages, which keeps a replay from bursting: 2 MB a second.
inline constexpr Nanoseconds kHeadSpacing{500'000};

struct HeadEvent {
  HostTime time;
  std::string channel;
  Bytes data;
};

// One asset of the scene.
struct HeadAsset {
  asset_ref_t ref;
  const Bytes* bytes;
};

// LOG_INFO, then the message types (sync/log/recorder_types.h), the manifest in pages, then every chunk of every asset; the
// last one kHeadSpacing before live_from. Sets info.live_from_ns.
std::vector<HeadEvent> log_head(const Identity& recorder, log_info_t info, const std::vector<HeadAsset>& assets,
                                HostTime live_from);

}  // namespace tactus::sync
