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

constexpr Nanoseconds kManifestPeriod{1'000'000'000};
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
    const std::vector<bool> none(chunk_count(asset.bytes.size()), false);
    if (!assets_.try_emplace(ref.hash, Outgoing{std::move(asset), none}).second) continue;
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
  m.chunks = static_cast<std::int32_t>(outgoing.wanted.size());
  m.data.assign(bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                bytes.begin() + static_cast<std::ptrdiff_t>(end));
  m.size = static_cast<std::int32_t>(m.data.size());
  bus_.publish(channels::kAssetChunk, m, Port::kBulk);
}

void SceneSender::poll(HostTime now) {
  while (const auto request = requests_.pop()) {
    const asset_request_t& r = request->message;
    const auto it = assets_.find(r.hash);
    if (it == assets_.end()) continue;
    std::vector<bool>& wanted = it->second.wanted;
    const std::size_t first = static_cast<std::size_t>(r.first_chunk);
    for (std::size_t i = first; i < wanted.size() && i < first + static_cast<std::size_t>(r.chunk_count); ++i) {
      if (!wanted[i]) ++wanted_;
      wanted[i] = true;
    }
  }
  if (now >= next_manifest_) {
    next_manifest_ = now + kManifestPeriod;
    announce();
  }
  int budget = kChunksPerPoll;
  for (auto& [hash, outgoing] : assets_) {
    for (std::size_t i = 0; wanted_ > 0 && budget > 0 && i < outgoing.wanted.size(); ++i) {
      if (!outgoing.wanted[i]) continue;
      send_chunk(hash, outgoing, i);
      outgoing.wanted[i] = false;
      --wanted_;
      --budget;
    }
  }
}

}  // namespace tactus::sync
