#include "sync/assets/scene_receiver.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <tactus/asset_chunk_t.hpp>
#include <tactus/asset_ref_t.hpp>
#include <tactus/asset_request_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/scene_manifest_t.hpp>
#include <tactus/scene_t.hpp>
#include <utility>

#include "sync/bus/bus.h"

namespace tactus::sync {
namespace {

// Chunks that arrive between two ticks of the slowest receiver: 20 ms at 4 chunks per millisecond, with a reserve.
constexpr std::size_t kChunkQueue = 4096;
constexpr std::size_t kManifestQueue = 128;
constexpr int kMaxPages = 64;  // pages of one manifest; SceneSender fills each with twelve assets
constexpr Nanoseconds kRetryAfter{100'000'000};
constexpr int kMaxRequests = 16;  // per round of requests, and assets in transfer at a time
constexpr int kMaxRun = 256;   // chunks per request: 64 ms of the sender's budget
// Chunks of one asset that may be requested ahead: the number that a sender sends in 250 ms.
constexpr std::size_t kWindow = 1024;

// Limits of one poll: about 0.5 ms.
constexpr int kPagesPerPoll = 8;
constexpr int kChunksPerPoll = 256;
constexpr std::size_t kHashedPerPoll = 96 << 10;
constexpr int kFreedPerPoll = 256;

bool same(const std::vector<asset_ref_t>& a, const std::vector<asset_ref_t>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const asset_ref_t& x, const asset_ref_t& y) {
    return x.hash == y.hash && x.size == y.size && x.kind == y.kind && x.name == y.name;
  });
}

}  // namespace

SceneReceiver::SceneReceiver(Bus& bus)
    : bus_(bus),
      manifests_(bus.queue<scene_manifest_t>(channels::kSceneManifest, kManifestQueue, Port::kBoth)),
      chunks_(bus.queue<asset_chunk_t>(channels::kAssetChunk, kChunkQueue, Port::kBoth)) {}

const Asset* SceneReceiver::asset(std::int64_t hash) const {
  const auto it = assets_.find(hash);
  if (it == assets_.end()) return nullptr;
  auto& [chunks, asset] = it->second;
  if (!chunks.empty()) asset.bytes.reserve(chunks.size() * kChunkBytes);
  for (const Bytes& chunk : chunks) asset.bytes.insert(asset.bytes.end(), chunk.begin(), chunk.end());
  chunks.clear();
  return &asset;
}

bool SceneReceiver::poll(HostTime now) {
  for (int left = kPagesPerPoll; left > 0; --left) {
    const auto page = manifests_.pop();
    if (!page) break;
    if (accept_sender(page->message.header, page->arrival)) process(page->message);
  }
  if (pages_new_) prepare_incoming();
  for (int left = kChunksPerPoll; left > 0; --left) {
    auto chunk = chunks_.pop();
    if (!chunk) break;
    process(std::move(chunk->message), now);
  }
  hash_some();
  free_some();
  if (incoming_.empty()) {
    progress_ = now;
    return complete();
  }
  if (now - progress_ > kNoProgressTimeout)
    ignore_sender(now);
  else if (now >= next_request_)
    request_missing(now);
  return false;
}

bool SceneReceiver::accept_sender(const header_t& header, HostTime arrival) {
  if (header.incarnation == ignored_sender_ && arrival < ignored_until_) return false;
  const SenderStatus status = sender_.on_page(header, arrival);
  if (status == SenderStatus::kFirst) {
    progress_ = arrival;
    pages_.clear();
  }
  return accepted(status);
}

// A manifest is the same for the whole incarnation of its sender, so pages of different repetitions complete each other.
void SceneReceiver::process(const scene_manifest_t& page) {
  if (page.pages > kMaxPages) return;
  const std::vector<asset_ref_t>* known = pages_.find(page.page);
  if (!known || !same(*known, page.assets)) pages_new_ = true;
  pages_.put(page.page, page.pages, page.assets);
  if (!pages_.complete()) pages_new_ = false;
}

void SceneReceiver::prepare_incoming() {
  pages_new_ = false;
  std::vector<asset_ref_t> manifest;
  std::set<std::int64_t> named;
  std::size_t total = 0, assets = 0;
  for (const auto& [number, refs] : pages_)
    for (const asset_ref_t& ref : refs) {
      const std::size_t size = static_cast<std::size_t>(ref.size);
      total += size;
      if (++assets > kMaxAssets || size > kMaxAssetBytes || total > kMaxTotalBytes) return;
      if (named.insert(ref.hash).second) manifest.push_back(ref);
    }
  for (auto it = incoming_.begin(); it != incoming_.end();) {
    const bool stays = named.contains(it->first);
    if (!stays) drop(it->second.chunks);
    it = stays ? std::next(it) : incoming_.erase(it);
  }
  refs_ = std::move(manifest);
  for (const asset_ref_t& ref : refs_)
    if (!assets_.contains(ref.hash)) incoming_[ref.hash].size = static_cast<std::size_t>(ref.size);
}

void SceneReceiver::process(asset_chunk_t&& m, HostTime now) {
  const auto it = incoming_.find(m.hash);
  if (it == incoming_.end()) return;
  Incoming& in = it->second;
  const std::size_t chunk = static_cast<std::size_t>(m.chunk), begin = chunk * kChunkBytes;
  if (static_cast<std::size_t>(m.chunks) != in.chunk_count() || in.has(chunk)) return;
  if (chunk < in.hashed || chunk >= in.hashed + kWindow) return;
  if (m.data.size() != std::min(kChunkBytes, in.size - begin)) return;
  if (bytes_held_ + m.data.size() > 2 * kMaxTotalBytes) return;  // the scene in use and the next one
  if (chunk >= in.chunks.size()) in.chunks.resize(chunk + 1);
  bytes_held_ += m.data.size();
  in.chunks[chunk] = std::move(m.data);
  progress_ = now;
}

void SceneReceiver::hash_some() {
  std::size_t left = kHashedPerPoll;
  for (auto it = incoming_.begin(); it != incoming_.end() && left >= kChunkBytes;) {
    Incoming& in = it->second;
    for (; in.has(in.hashed) && left >= kChunkBytes; ++in.hashed, left -= kChunkBytes)
      in.hash = fnv1a_64(in.hash, in.chunks[in.hashed].data(), in.chunks[in.hashed].size());
    if (in.hashed < in.chunk_count()) {
      ++it;
      continue;
    }
    const std::int64_t hash = it->first;
    if (static_cast<std::int64_t>(in.hash) != hash) {  // a forged or mixed-up chunk: starts again
      drop(in.chunks);
      in.hashed = 0;
      in.hash = kFnv1aBegin;
      ++it;
      continue;
    }
    const auto ref =
        std::find_if(refs_.begin(), refs_.end(), [&](const asset_ref_t& r) { return r.hash == hash; });
    assets_[hash] = {std::move(in.chunks), {ref->kind, ref->name, {}}};
    it = incoming_.erase(it);
  }
}

void SceneReceiver::drop(std::deque<Bytes>& chunks) { garbage_.push_back(std::exchange(chunks, {})); }

void SceneReceiver::free_some() {
  for (int left = kFreedPerPoll; left > 0 && !garbage_.empty(); --left) {
    std::deque<Bytes>& chunks = garbage_.back();
    if (chunks.empty()) {
      garbage_.pop_back();
      continue;
    }
    bytes_held_ -= chunks.back().size();
    chunks.pop_back();
  }
}

// Ignores the current sender for a while: it announces assets, but does not send their chunks.
void SceneReceiver::ignore_sender(HostTime now) {
  for (auto& [hash, in] : incoming_) drop(in.chunks);
  incoming_.clear();
  refs_.clear();
  pages_.clear();
  ignored_sender_ = sender_.incarnation();
  sender_ = SingleSender(SingleSender::kAnyRun, kSilence);
  ignored_until_ = now + kNoProgressTimeout;
}

void SceneReceiver::request_missing(HostTime now) {
  next_request_ = now + kRetryAfter;
  int left = kMaxRequests, in_progress = 0;
  for (const auto& [hash, in] : incoming_) {
    if (left == 0 || ++in_progress > kMaxRequests) break;
    const std::size_t end = std::min(in.chunk_count(), in.hashed + kWindow);
    for (std::size_t i = in.hashed; i < end && left > 0;) {
      if (in.has(i)) {
        ++i;
        continue;
      }
      const std::size_t first = i;
      while (i < end && !in.has(i) && i - first < kMaxRun) ++i;
      asset_request_t m{};
      m.header.sim_time_ns = -1;
      m.hash = hash;
      m.first_chunk = static_cast<std::int32_t>(first);
      m.chunk_count = static_cast<std::int32_t>(i - first);
      bus_.publish(channels::kAssetRequest, m, Port::kBulk);
      --left;
    }
  }
}

bool SceneReceiver::complete() {
  const auto is_scene = [](const asset_ref_t& r) { return r.kind == asset_ref_t::SCENE; };
  const auto ref = std::find_if(refs_.begin(), refs_.end(), is_scene);
  if (ref == refs_.end() || ref->hash == refused_scene_ || (scene_ && ref->hash == scene_hash_)) return false;
  const Asset* found = asset(ref->hash);
  auto decoded = found ? decode_asset<scene_t>(found->bytes) : std::nullopt;
  if (!decoded) {
    refused_scene_ = ref->hash;
    return false;
  }
  scene_ = std::move(*decoded);
  scene_hash_ = ref->hash;
  std::set<std::int64_t> named;
  for (const asset_ref_t& r : refs_) named.insert(r.hash);
  for (auto it = assets_.begin(); it != assets_.end();) {
    const bool stays = named.contains(it->first);
    if (!stays) {
      drop(it->second.chunks);
      garbage_.emplace_back().push_back(std::move(it->second.asset.bytes));
    }
    it = stays ? std::next(it) : assets_.erase(it);
  }
  return true;
}

}  // namespace tactus::sync
