#include "sync/assets/scene_sender.h"

#include <algorithm>
#include <stdexcept>
#include <tactus/asset_chunk_t.hpp>
#include <tactus/asset_ref_t.hpp>
#include <tactus/asset_request_t.hpp>
#include <tactus/scene_manifest_t.hpp>

#include "sync/assets/scene_receiver.h"
#include "sync/bus/bus.h"

namespace tactus::sync {
namespace {

constexpr std::size_t kRefsPerPage = 12;  // of at most 100 bytes each
constexpr std::size_t kMaxName = 64;
constexpr std::size_t kRequestQueue = 256;

std::size_t chunk_count(std::size_t bytes) { return (bytes + kChunkBytes - 1) / kChunkBytes; }

}  // namespace

SceneSender::SceneSender(Bus& bus, std::vector<Asset> assets)
    : bus_(bus), requests_(bus.queue<asset_request_t>(channels::kAssetRequest, kRequestQueue, Port::kBoth)) {
  std::size_t total = 0;
  for (Asset& asset : assets) {
    if (asset.bytes.empty()) continue;
    asset_ref_t ref{};
    ref.hash = fnv1a_64(asset.bytes.data(), asset.bytes.size());
    ref.size = static_cast<std::int32_t>(asset.bytes.size());
    ref.kind = asset.kind;
    ref.name = asset.name.substr(0, kMaxName);
    const std::size_t chunks = chunk_count(asset.bytes.size());
    if (!assets_.try_emplace(ref.hash, Outgoing{std::move(asset), chunks, {}}).second) continue;
    refs_.push_back(ref);
    total += static_cast<std::size_t>(ref.size);
  }
  if (refs_.size() > SceneReceiver::kMaxAssets || total > SceneReceiver::kMaxTotalBytes)
    throw std::runtime_error("the scene has " + std::to_string(refs_.size()) + " meshes and images of " +
                             std::to_string(total >> 20) + " MB together; a node accepts at most " +
                             std::to_string(SceneReceiver::kMaxAssets) + " and " +
                             std::to_string(SceneReceiver::kMaxTotalBytes >> 20) + " MB; remove some");
}

void SceneSender::announce() {
  const std::size_t pages = std::max<std::size_t>(1, (refs_.size() + kRefsPerPage - 1) / kRefsPerPage);
  for (std::size_t page = 0; page < pages; ++page) {
    scene_manifest_t m{};
    m.header.sim_time_ns = -1;
    m.page = static_cast<std::int32_t>(page);
    m.pages = static_cast<std::int32_t>(pages);
    const std::size_t begin = page * kRefsPerPage, end = std::min(refs_.size(), begin + kRefsPerPage);
    m.assets.assign(refs_.begin() + static_cast<std::ptrdiff_t>(begin),
                    refs_.begin() + static_cast<std::ptrdiff_t>(end));
    m.count = static_cast<std::int32_t>(m.assets.size());
    bus_.publish(channels::kSceneManifest, m, Port::kBulk);
  }
}

void SceneSender::send_chunk(std::int64_t hash, const Outgoing& outgoing, std::size_t chunk) {
  const Bytes& bytes = outgoing.asset.bytes;
  const std::size_t begin = chunk * kChunkBytes, end = std::min(bytes.size(), begin + kChunkBytes);
  asset_chunk_t m{};
  m.header.sim_time_ns = -1;
  m.hash = hash;
  m.chunk = static_cast<std::int32_t>(chunk);
  m.chunks = static_cast<std::int32_t>(outgoing.chunk_count);
  m.data.assign(bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                bytes.begin() + static_cast<std::ptrdiff_t>(end));
  m.size = static_cast<std::int32_t>(m.data.size());
  bus_.publish(channels::kAssetChunk, m, Port::kBulk);
}

void SceneSender::receive_requests() {
  while (const auto request = requests_.pop()) {
    const asset_request_t& r = request->message;
    const auto it = assets_.find(r.hash);
    if (it == assets_.end()) continue;
    const std::size_t first = static_cast<std::size_t>(r.first_chunk);
    const std::size_t end = std::min(it->second.chunk_count, first + static_cast<std::size_t>(r.chunk_count));
    it->second.wanted.add(first, end);
    waiting_ = true;
  }
}

void SceneSender::announce_soon() { next_manifest_ = std::min(next_manifest_, last_manifest_ + kOfferPeriod); }

void SceneSender::poll(HostTime now, Nanoseconds period) {
  receive_requests();
  if (now >= next_manifest_) {
    last_manifest_ = now;
    next_manifest_ = now + period;
    announce();
  }
  for (int budget = kChunksPerPoll; waiting_ && budget > 0; --budget) waiting_ = send_next();
}

// The next requested chunk of the next asset. False: no chunk is requested.
bool SceneSender::send_next() {
  auto at = assets_.upper_bound(last_sent_);
  for (std::size_t passed = 0; passed < assets_.size(); ++passed, ++at) {
    if (at == assets_.end()) at = assets_.begin();
    const auto chunk = at->second.wanted.take();
    if (!chunk) continue;
    send_chunk(at->first, at->second, *chunk);
    last_sent_ = at->first;
    return true;
  }
  return false;
}

}  // namespace tactus::sync
