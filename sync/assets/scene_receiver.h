// Receives the scene and its assets from the bus: requests the chunks that are missing. sync/assets/scene_sender.h sends them.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <tactus/asset_chunk_t.hpp>
#include <tactus/asset_ref_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/scene_manifest_t.hpp>
#include <tactus/scene_t.hpp>
#include <vector>

#include "sync/assets/asset.h"
#include "sync/bus/identity.h"
#include "sync/bus/page_assembler.h"
#include "sync/clocks/single_sender.h"
#include "sync/time/time.h"

namespace tactus::sync {

class Bus;
template <class Message>
class Queue;

// The receiving side, in every renderer and in the recorder. Listens on both ports (a replayed log has only one).
//
// It runs in loops of 1 kHz, so one poll costs less than 1 ms for any input: memory is allocated chunk by chunk as it is
// filled, and hashing and freeing are done a bounded amount at a time. Only the decoding of a complete scene takes longer;
// poll then returns true.
class SceneReceiver {
 public:
  // A scene is complete or absent. A manifest with more or larger assets is refused.
  static constexpr std::size_t kMaxAssetBytes = 64 << 20;
  static constexpr std::size_t kMaxTotalBytes = 256 << 20;
  static constexpr std::size_t kMaxAssets = 512;
  // Accepts the manifests of one sender. Accepts another one when this sender has been silent for kSilence, two periods of its
  // manifest. A sender that has sent no useful chunk for kNoProgressTimeout is ignored for the same time.
  static constexpr Nanoseconds kSilence{2'500'000'000};
  static constexpr Nanoseconds kNoProgressTimeout{3'000'000'000};

  explicit SceneReceiver(Bus& bus);

  // Call it once a tick. Requests missing chunks, rate-limited (again after 100 ms). Returns true when a new scene has just
  // become complete; the previous one stays until then.
  bool poll(HostTime now);

  const scene_t* scene() const { return scene_ ? &*scene_ : nullptr; }
  // Null when no asset has that hash. Joins the chunks at the first call.
  const Asset* asset(std::int64_t hash) const;
  const std::vector<asset_ref_t>& manifest() const { return refs_; }
  // Memory of chunks and assets, bytes.
  std::size_t bytes_held() const { return bytes_held_; }

 private:
  // The first `hashed` chunks are present and hashed; of the following ones only the next kWindow are accepted.
  struct Incoming {
    std::size_t size = 0;
    std::deque<Bytes> chunks;  // empty: missing
    std::size_t hashed = 0;
    std::uint64_t hash = kFnv1aBegin;
    std::size_t chunk_count() const { return (size + kChunkBytes - 1) / kChunkBytes; }
    bool has(std::size_t chunk) const { return chunk < chunks.size() && !chunks[chunk].empty(); }
  };
  struct Arrived {
    std::deque<Bytes> chunks;  // until they are joined
    Asset asset;
  };
  bool accept_sender(const header_t& header, HostTime arrival);
  void process(const scene_manifest_t& page);
  void process(asset_chunk_t&& chunk, HostTime now);
  void prepare_incoming();
  void hash_some();
  void free_some();
  void drop(std::deque<Bytes>& chunks);
  void ignore_sender(HostTime now);
  void request_missing(HostTime now);
  bool complete();

  Bus& bus_;
  Queue<scene_manifest_t>& manifests_;
  Queue<asset_chunk_t>& chunks_;
  std::optional<scene_t> scene_;
  std::int64_t scene_hash_ = 0;
  std::int64_t refused_scene_ = 0;  // complete, but not decodable: not requested again
  SingleSender sender_{SingleSender::kAnyRun, kSilence};  // of the pages below
  std::int64_t ignored_sender_ = 0;       // ignored incarnation
  HostTime ignored_until_{};
  PageGroup<std::vector<asset_ref_t>> pages_;
  bool pages_new_ = false;
  std::vector<asset_ref_t> refs_;
  std::map<std::int64_t, Incoming> incoming_;
  HostTime progress_{};  // when a useful chunk arrived last
  mutable std::map<std::int64_t, Arrived> assets_;
  std::deque<std::deque<Bytes>> garbage_;
  std::size_t bytes_held_ = 0;
  HostTime next_request_{};
};

}  // namespace tactus::sync
