// Sends the scene and its assets over the bus: announces them once a second, and sends the chunks that nodes request. Assets
// are identified by the hash of their content, so receivers keep a scene when the simulation restarts with it.
#pragma once

#include <cstdint>
#include <map>
#include <tactus/asset_ref_t.hpp>
#include <tactus/asset_request_t.hpp>
#include <vector>

#include "sync/assets/asset.h"
#include "sync/time/time.h"

namespace tactus::sync {

class Bus;
template <class Message>
class Queue;

// The sending side, in sim_node. Sends at most kChunksPerPoll chunks per call (bulk port), so that a late joiner never delays
// a tick by more than a few microseconds.
class SceneSender {
 public:
  static constexpr int kChunksPerPoll = 4;
  // Throws std::runtime_error with one sentence when the assets exceed the limits of the receivers.
  SceneSender(Bus& bus, std::vector<Asset> assets);
  // Call it once a tick: sends the manifest when due, then requested chunks.
  void poll(HostTime now);
  const std::vector<asset_ref_t>& manifest() const { return refs_; }

 private:
  struct Outgoing {
    Asset asset;
    std::vector<bool> wanted;  // per chunk: requested and not yet sent
  };
  void announce();
  void send_chunk(std::int64_t hash, const Outgoing& outgoing, std::size_t chunk);

  Bus& bus_;
  Queue<asset_request_t>& requests_;
  std::map<std::int64_t, Outgoing> assets_;
  std::vector<asset_ref_t> refs_;
  HostTime next_manifest_{};
  std::size_t wanted_ = 0;
};

}  // namespace tactus::sync
