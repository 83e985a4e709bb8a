#include "sync/tools/recorder/recorder_head.h"

#include <algorithm>
#include <map>
#include <tactus/asset_chunk_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/scene_manifest_t.hpp>

#include "sync/bus/decode.h"
#include "sync/log/recorder_types.h"

namespace tactus::sync {
namespace {

// The header has the same length on the wire in every type.
void stamp(header_t& h, const Identity& id, std::int64_t seq, HostTime time) {
  h = {-1, to_ns(time), id.clock, id.run_id, id.source, id.incarnation, seq};
}

std::vector<scene_manifest_t> manifest_pages(const std::vector<HeadAsset>& assets) {
  std::vector<scene_manifest_t> pages;
  for (const HeadAsset& asset : assets) {
    if (pages.empty()) pages.emplace_back();
    pages.back().assets.push_back(asset.ref);
    ++pages.back().count;
    if (static_cast<std::size_t>(pages.back().getEncodedSize()) > channels::kMaxMessageBytes) {
      pages.back().assets.pop_back();
      --pages.back().count;
      pages.emplace_back();
      pages.back().assets.push_back(asset.ref);
      pages.back().count = 1;
    }
  }
  for (std::size_t i = 0; i < pages.size(); ++i) {
    pages[i].page = static_cast<std::int32_t>(i);
    pages[i].pages = static_cast<std::int32_t>(pages.size());
  }
  return pages;
}

std::vector<asset_chunk_t> chunks_of(const HeadAsset& asset) {
  std::vector<asset_chunk_t> chunks;
  const Bytes& bytes = *asset.bytes;
  for (std::size_t at = 0; at < bytes.size(); at += kChunkBytes) {
    asset_chunk_t c{};
    c.hash = asset.ref.hash;
    c.chunk = static_cast<std::int32_t>(chunks.size());
    c.size = static_cast<std::int32_t>(std::min(kChunkBytes, bytes.size() - at));
    c.data.assign(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                  bytes.begin() + static_cast<std::ptrdiff_t>(at) + c.size);
    chunks.push_back(std::move(c));
  }
  for (asset_chunk_t& c : chunks) c.chunks = static_cast<std::int32_t>(chunks.size());
  return chunks;
}

}  // namespace

std::vector<HeadEvent> log_head(const Identity& recorder, log_info_t info, const std::vector<HeadAsset>& assets,
                                HostTime live_from) {
  std::vector<scene_manifest_t> pages = manifest_pages(assets);
  std::vector<asset_chunk_t> chunks;
  for (const HeadAsset& asset : assets)
    for (asset_chunk_t& c : chunks_of(asset)) chunks.push_back(std::move(c));

  std::vector<HeadEvent> head;
  const std::vector<std::string> types = log_types();
  const auto events = static_cast<std::int64_t>(1 + types.size() + pages.size() + chunks.size());
  std::map<std::string, std::int64_t> seq;
  const auto add = [&](const char* channel, auto& message) {
    const HostTime time = live_from - (events - static_cast<std::int64_t>(head.size())) * kHeadSpacing;
    stamp(message.header, recorder, seq[channel]++, time);
    head.push_back({time, channel, encode(message)});
  };
  info.live_from_ns = to_ns(live_from);
  add(channels::kLogInfo, info);
  for (const std::string& text : types) {
    const HostTime time = live_from - (events - static_cast<std::int64_t>(head.size())) * kHeadSpacing;
    head.push_back({time, kLogTypes, Bytes(text.begin(), text.end())});
  }
  for (auto& page : pages) add(channels::kSceneManifest, page);
  for (auto& chunk : chunks) add(channels::kAssetChunk, chunk);
  return head;
}

}  // namespace tactus::sync
