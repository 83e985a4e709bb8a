#include "sync/tools/picture_reader.h"

#include <algorithm>

namespace tactus::sync {
namespace {
constexpr std::int32_t kChunkBytes = 1024;
}

std::optional<StreamedPicture> PictureReader::push(const picture_chunk_t& m) {
  const bool last = m.chunk == m.chunks - 1;
  if (m.chunks > kMaxChunks || m.chunk < 0 || m.chunk >= m.chunks ||
      m.size != static_cast<std::int32_t>(m.data.size()) || m.size < 1 || m.size > kChunkBytes ||
      (!last && m.size != kChunkBytes))
    return std::nullopt;
  if (!partials_.contains(m.header.source) && partials_.size() == kMaxSources)
    partials_.erase(std::min_element(partials_.begin(), partials_.end(), [](const auto& a, const auto& b) {
      return a.second.last_message < b.second.last_message;
    }));
  Partial& p = partials_[m.header.source];
  p.last_message = ++messages_;
  const bool another_life = p.incarnation != m.header.incarnation;
  if (!another_life && m.picture < p.picture) return std::nullopt;  // overtaken by the next picture
  if (another_life || m.picture > p.picture) {
    skipped_ += static_cast<std::int64_t>(p.chunks.size());
    p.chunks.clear();
    p.incarnation = m.header.incarnation;
    p.picture = m.picture;
  }
  const auto* group = p.chunks.add({p.incarnation, p.picture}, m.chunk, m.chunks, m.data);
  if (!group) return std::nullopt;
  StreamedPicture whole{m.header.source, m.picture, m.header.sim_time_ns, m.presented_ns, m.width, m.height, {}};
  for (const auto& [number, c] : group->pages) whole.jpeg.insert(whole.jpeg.end(), c.begin(), c.end());
  return whole;
}

}  // namespace tactus::sync
