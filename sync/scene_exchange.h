// Carries the scene and its assets: sim_node announces them once a second, a node that lacks chunks asks for them.
// Everything is named by the hash of its content, so a restarted simulation with the same scene costs nothing.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tactus/asset_chunk_t.hpp>
#include <tactus/asset_ref_t.hpp>
#include <tactus/asset_request_t.hpp>
#include <tactus/scene_manifest_t.hpp>
#include <tactus/scene_t.hpp>
#include <vector>

#include "sync/bus.h"

namespace tactus::sync {

inline constexpr std::size_t kChunkBytes = 1024;
using Bytes = std::vector<std::uint8_t>;

struct Asset {
  std::int8_t kind = asset_ref_t::SCENE;
  std::string name;
  Bytes bytes;
};

// The sending side, in sim_node. Sends at most kChunksPerPoll chunks a call (bulk port), so that a late joiner never
// delays a tick by more than a few microseconds.
class SceneSender {
 public:
  static constexpr int kChunksPerPoll = 4;
  SceneSender(Bus& bus, std::vector<Asset> assets);
  // Once a tick: the manifest when due, then chunks that were asked for.
  void poll(HostTime now);
  const std::vector<asset_ref_t>& manifest() const { return refs_; }

 private:
  struct Outgoing {
    Asset asset;
    std::vector<bool> wanted;  // per chunk: asked for and not yet sent
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

// The receiving side, in every renderer and in the recorder. Listens on both ports (a replayed log has only one).
class SceneReceiver {
 public:
  // A scene is complete or it is not there; no asset is larger than this.
  static constexpr std::size_t kMaxAssetBytes = 64 << 20;
  explicit SceneReceiver(Bus& bus);

  // Once a tick. Asks for what is missing, rate-limited (again after 100 ms). True when a scene has just become
  // complete that differs from the one before.
  bool poll(HostTime now);

  const scene_t* scene() const { return scene_ ? &*scene_ : nullptr; }
  // Null when there is none of that hash.
  const Asset* asset(std::int64_t hash) const;
  const std::vector<asset_ref_t>& manifest() const { return refs_; }

 private:
  struct Incoming {
    Bytes bytes;
    std::vector<bool> have;  // per chunk
    std::size_t missing = 0;
  };
  void take(const scene_manifest_t& page);
  void take(const asset_chunk_t& chunk);
  void expect(const std::vector<asset_ref_t>& manifest);
  void ask(HostTime now);
  bool complete();

  Bus& bus_;
  Queue<scene_manifest_t>& manifests_;
  Queue<asset_chunk_t>& chunks_;
  std::optional<scene_t> scene_;
  std::int64_t scene_hash_ = 0;
  std::int64_t refused_scene_ = 0;  // complete, but not decodable: not asked for again
  std::int64_t pages_of_ = 0;       // incarnation that the pages below come from
  std::map<int, std::vector<asset_ref_t>> pages_;
  std::vector<asset_ref_t> refs_;
  std::map<std::int64_t, Incoming> incoming_;
  std::map<std::int64_t, Asset> assets_;
  HostTime next_request_{};
};

}  // namespace tactus::sync
