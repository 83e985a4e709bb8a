// Carries the scene and its assets: sim_node announces them once a second, a node that lacks chunks asks for them.
// Everything is named by the hash of its content, so a restarted simulation with the same scene costs nothing.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <tactus/asset_chunk_t.hpp>
#include <tactus/asset_ref_t.hpp>
#include <tactus/asset_request_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/scene_manifest_t.hpp>
#include <tactus/scene_t.hpp>
#include <vector>

#include "sync/assets/asset.h"
#include "sync/bus/bus.h"
#include "sync/bus/page_assembler.h"

namespace tactus::sync {

inline constexpr std::size_t kChunkBytes = 1024;

// The sending side, in sim_node. Sends at most kChunksPerPoll chunks a call (bulk port), so that a late joiner
// never delays a tick by more than a few microseconds.
class SceneSender {
 public:
  static constexpr int kChunksPerPoll = 4;
  // Throws std::runtime_error with one sentence when that is more than any receiver takes.
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
//
// Lives in loops of 1 kHz, so whatever arrives one poll costs less than 1 ms: memory comes chunk by chunk as it is
// filled, and hashing and freeing are done a bounded amount at a time. Decoding a scene whose hash is right is the
// exception; it happens when poll returns true.
class SceneReceiver {
 public:
  // A scene is complete or it is not there. A manifest of more, or of larger ones, is refused.
  static constexpr std::size_t kMaxAssetBytes = 64 << 20;
  static constexpr std::size_t kMaxTotalBytes = 256 << 20;
  static constexpr std::size_t kMaxAssets = 512;
  // A sender of manifests is listened to, and no other, until it has been silent for two periods of its manifest
  // or has sent nothing of use for kGiveUp; then it is not listened to for as long.
  static constexpr Nanoseconds kSilence{2'500'000'000};
  static constexpr Nanoseconds kGiveUp{3'000'000'000};

  explicit SceneReceiver(Bus& bus);

  // Once a tick. Asks for what is missing, rate-limited (again after 100 ms). True when a scene has just become
  // complete that differs from the one before, which stays until then.
  bool poll(HostTime now);

  const scene_t* scene() const { return scene_ ? &*scene_ : nullptr; }
  // Null when there is none of that hash. Puts its chunks together when it is asked for first.
  const Asset* asset(std::int64_t hash) const;
  const std::vector<asset_ref_t>& manifest() const { return refs_; }
  // Manifests that no scene can have.
  std::int64_t refused() const { return refused_; }
  // What chunks and assets take up.
  std::size_t bytes_held() const { return bytes_held_; }

 private:
  // The first `hashed` chunks are there and hashed; of those behind only the next kWindow are let in.
  struct Incoming {
    std::size_t size = 0;
    std::deque<Bytes> chunks;  // empty: not there
    std::size_t hashed = 0;
    std::uint64_t hash = kFnv1aBegin;
    std::size_t chunk_count() const { return (size + kChunkBytes - 1) / kChunkBytes; }
    bool has(std::size_t chunk) const { return chunk < chunks.size() && !chunks[chunk].empty(); }
  };
  struct Arrived {
    std::deque<Bytes> chunks;  // until they are put together
    Asset asset;
  };
  bool follow(const header_t& header, HostTime arrival);
  void take(const scene_manifest_t& page);
  void take(asset_chunk_t&& chunk, HostTime now);
  void expect();
  void hash_some();
  void free_some();
  void drop(std::deque<Bytes>& chunks);
  void give_up(HostTime now);
  void request_missing(HostTime now);
  bool complete();

  Bus& bus_;
  Queue<scene_manifest_t>& manifests_;
  Queue<asset_chunk_t>& chunks_;
  std::optional<scene_t> scene_;
  std::int64_t scene_hash_ = 0;
  std::int64_t refused_scene_ = 0;  // complete, but not decodable: not asked for again
  std::int64_t followed_ = 0;       // incarnation that the pages below come from
  HostTime heard_{};                // of it
  std::int64_t given_up_ = 0;       // incarnation that is not listened to
  HostTime given_up_until_{};
  PageGroup<std::vector<asset_ref_t>> pages_;
  bool pages_new_ = false;
  std::vector<asset_ref_t> refs_;
  std::map<std::int64_t, Incoming> incoming_;
  HostTime progress_{};  // when a chunk of use arrived last
  mutable std::map<std::int64_t, Arrived> assets_;
  std::deque<std::deque<Bytes>> garbage_;
  std::size_t bytes_held_ = 0;
  std::int64_t refused_ = 0;
  HostTime next_request_{};
};

}  // namespace tactus::sync
