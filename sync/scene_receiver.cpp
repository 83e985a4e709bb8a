#include <algorithm>

#include "sync/scene_exchange.h"

namespace tactus::sync {
namespace {

// Chunks wait here between two ticks of the slowest receiver (20 ms at 4 a millisecond).
constexpr std::size_t kChunkQueue = 4096;
constexpr std::size_t kManifestQueue = 64;
constexpr std::size_t kMostAssets = 2000;
constexpr Nanoseconds kAskAgainAfter{100'000'000};
constexpr int kMostRequests = 16;   // per round of asking
constexpr int kLongestRun = 256;    // chunks per request: 64 ms of the sender's budget

std::size_t chunk_count(std::size_t bytes) { return (bytes + kChunkBytes - 1) / kChunkBytes; }

}  // namespace

SceneReceiver::SceneReceiver(Bus& bus)
    : bus_(bus),
      manifests_(bus.queue<scene_manifest_t>(channels::kSceneManifest, kManifestQueue, Port::kBoth)),
      chunks_(bus.queue<asset_chunk_t>(channels::kAssetChunk, kChunkQueue, Port::kBoth)) {}

const Asset* SceneReceiver::asset(std::int64_t hash) const {
  const auto it = assets_.find(hash);
  return it == assets_.end() ? nullptr : &it->second;
}

bool SceneReceiver::poll(HostTime now) {
  while (const auto page = manifests_.pop()) take(page->message);
  while (const auto chunk = chunks_.pop()) take(chunk->message);
  if (!incoming_.empty()) {
    if (now >= next_request_) ask(now);
    return false;
  }
  return complete();
}

// A manifest is the same for the whole life of its sender, so pages of different sendings complete each other.
void SceneReceiver::take(const scene_manifest_t& page) {
  if (pages_of_ != page.header.incarnation || (!pages_.empty() && pages_.rbegin()->first >= page.pages)) pages_.clear();
  pages_of_ = page.header.incarnation;
  pages_[page.page] = page.assets;
  if (static_cast<int>(pages_.size()) != page.pages) return;
  std::vector<asset_ref_t> all;
  for (const auto& [index, refs] : pages_) all.insert(all.end(), refs.begin(), refs.end());
  if (all.size() <= kMostAssets) expect(all);
}

void SceneReceiver::expect(const std::vector<asset_ref_t>& manifest) {
  const auto named = [&](std::int64_t hash) {
    return std::any_of(manifest.begin(), manifest.end(), [&](const asset_ref_t& r) { return r.hash == hash; });
  };
  std::erase_if(incoming_, [&](const auto& entry) { return !named(entry.first); });
  refs_ = manifest;
  for (const asset_ref_t& ref : manifest) {
    const std::size_t size = static_cast<std::size_t>(ref.size);
    if (size > kMaxAssetBytes || assets_.contains(ref.hash) || incoming_.contains(ref.hash)) continue;
    incoming_[ref.hash] = {Bytes(size), std::vector<bool>(chunk_count(size)), chunk_count(size)};
  }
}

void SceneReceiver::take(const asset_chunk_t& m) {
  const auto it = incoming_.find(m.hash);
  if (it == incoming_.end()) return;
  Incoming& in = it->second;
  const std::size_t chunk = static_cast<std::size_t>(m.chunk), begin = chunk * kChunkBytes;
  if (static_cast<std::size_t>(m.chunks) != in.have.size() || chunk >= in.have.size() || in.have[chunk]) return;
  if (m.data.size() != std::min(kChunkBytes, in.bytes.size() - begin)) return;
  std::copy(m.data.begin(), m.data.end(), in.bytes.begin() + static_cast<std::ptrdiff_t>(begin));
  in.have[chunk] = true;
  if (--in.missing > 0) return;
  if (fnv1a_64(in.bytes.data(), in.bytes.size()) != m.hash) {  // a forged or mixed-up chunk: begin again
    in.have.assign(in.have.size(), false);
    in.missing = in.have.size();
    return;
  }
  const auto ref = std::find_if(refs_.begin(), refs_.end(), [&](const asset_ref_t& r) { return r.hash == m.hash; });
  if (ref != refs_.end()) assets_[m.hash] = {ref->kind, ref->name, std::move(in.bytes)};
  incoming_.erase(it);
}

void SceneReceiver::ask(HostTime now) {
  next_request_ = now + kAskAgainAfter;
  int left = kMostRequests;
  for (const auto& [hash, in] : incoming_) {
    for (std::size_t i = 0; i < in.have.size() && left > 0;) {
      if (in.have[i]) {
        ++i;
        continue;
      }
      const std::size_t first = i;
      while (i < in.have.size() && !in.have[i] && i - first < kLongestRun) ++i;
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
  std::erase_if(assets_, [&](const auto& entry) {
    return std::none_of(refs_.begin(), refs_.end(), [&](const asset_ref_t& r) { return r.hash == entry.first; });
  });
  return true;
}

}  // namespace tactus::sync
