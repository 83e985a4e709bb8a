// Sends the scene and its assets over the bus: announces them once a second, faster before the world begins and to a new process,
// and sends the chunks that nodes request. Assets are identified by the hash of their content, so receivers keep a scene when the
// simulation restarts with it.
#pragma once

#include <cstdint>
#include <map>
#include <tactus/asset_ref_t.hpp>
#include <tactus/asset_request_t.hpp>
#include <vector>

#include "sync/assets/asset.h"
#include "sync/assets/chunk_ranges.h"
#include "sync/time/time.h"

namespace tactus::sync {

class Bus;
template <class Message>
class Queue;

// The sending side, in sim_node. Sends at most kChunksPerPoll chunks per call (bulk port). It reads at most a queue of requests,
// each of bounded cost, so that no receiver and no flood of requests delays a tick by more than some tens of microseconds. The
// assets and their chunks take turns, so that a receiver that repeats its requests without end delays the others only.
class SceneSender {
 public:
  static constexpr int kChunksPerPoll = 4;
  // Interval of the manifest while the world runs, and before it begins: a receiver that joins after one manifest must have the
  // next, and the scene, before the first instant of the world.
  static constexpr Nanoseconds kPeriod{1'000'000'000}, kOfferPeriod{50'000'000};
  // Throws std::runtime_error with one sentence when the assets exceed the limits of the receivers.
  SceneSender(Bus& bus, std::vector<Asset> assets);
  // Call it once a tick: sends the manifest when due, then requested chunks. period: the interval until the next manifest.
  void poll(HostTime now, Nanoseconds period = kPeriod);
  // A new process lacks the scene: the next manifest is due kOfferPeriod after the last one.
  void announce_soon();
  const std::vector<asset_ref_t>& manifest() const { return refs_; }

 private:
  struct Outgoing {
    Asset asset;
    std::size_t chunk_count = 0;
    ChunkRanges wanted;  // requested and not yet sent
  };
  void announce();
  void receive_requests();
  bool send_next();
  void send_chunk(std::int64_t hash, const Outgoing& outgoing, std::size_t chunk);

  Bus& bus_;
  Queue<asset_request_t>& requests_;
  std::map<std::int64_t, Outgoing> assets_;
  std::int64_t last_sent_ = 0;  // the asset of the last chunk
  bool waiting_ = false;        // a chunk may be requested and not sent
  std::vector<asset_ref_t> refs_;
  HostTime last_manifest_{}, next_manifest_{};
};

}  // namespace tactus::sync
