#include "visual_node/video/picture_stream.h"

#include <algorithm>
#include <mutex>

namespace tactus::visual {

// Shared by both threads: the newest picture that is ready to send. The loop only tries the lock.
struct PictureStream::Outbox {
  std::mutex mutex;
  std::vector<picture_chunk_t> ready;
  std::int64_t pictures = 0;
};

std::vector<picture_chunk_t> chunks_of(const Jpeg& jpeg, std::int64_t picture, std::int64_t sim_time_ns,
                                       std::int64_t presented_ns) {
  std::vector<picture_chunk_t> chunks((jpeg.bytes.size() + kPictureChunkBytes - 1) / kPictureChunkBytes);
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    picture_chunk_t& c = chunks[i];
    c.header.sim_time_ns = sim_time_ns;
    c.picture = picture;
    c.presented_ns = presented_ns;
    c.width = static_cast<std::int16_t>(jpeg.width);
    c.height = static_cast<std::int16_t>(jpeg.height);
    c.chunk = static_cast<std::int32_t>(i);
    c.chunks = static_cast<std::int32_t>(chunks.size());
    const auto begin = jpeg.bytes.begin() + static_cast<std::ptrdiff_t>(i * kPictureChunkBytes);
    const std::ptrdiff_t size = std::min<std::ptrdiff_t>(kPictureChunkBytes, jpeg.bytes.end() - begin);
    c.data.assign(begin, begin + size);
    c.size = static_cast<std::int32_t>(size);
  }
  return chunks;
}

PictureStream::PictureStream() : outbox_(std::make_shared<Outbox>()) {}
PictureStream::~PictureStream() = default;

void PictureStream::begin(int width, int height, const Settings& s) {
  sink_.reset();
  sending_.clear();
  sent_ = 0;
  if (s.stream_Hz <= 0) return;
  period_ = sync::from_seconds(1 / s.stream_Hz);
  next_ = {};
  const auto make = [box = outbox_, width, height, to_width = s.stream_width,
                     quality = s.stream_quality](const Picture& p) {
    const Jpeg jpeg = encode_jpeg(p.rgba, width, height, to_width, quality);
    if (jpeg.bytes.empty()) return false;
    const std::lock_guard lock(box->mutex);
    box->ready = chunks_of(jpeg, box->pictures++, p.tick, p.presented_ns);
    return true;
  };
  constexpr std::size_t kWaiting = 1;
  sink_ = std::make_unique<FrameSink>(
      kWaiting, static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4, make);
}

void PictureStream::add(sync::HostTime now, std::int64_t sim_time_ns, sync::HostTime presented,
                        const std::function<void(std::span<std::uint8_t>)>& read) {
  // A tick may wake slightly early: at the full frame rate no picture is skipped for that.
  if (!sink_ || now + period_ / 4 < next_) return;
  auto picture = sink_->take_empty();
  if (!picture) return;  // the previous one is still being encoded: try at the next tick
  // Keeps the period without catching up.
  next_ = std::max(next_ + period_, now + period_ / 2);
  picture->tick = sim_time_ns;  // identifies the picture here
  picture->presented_ns = sync::to_ns(presented);
  read(picture->rgba);
  sink_->push(std::move(*picture));
}

std::vector<picture_chunk_t> PictureStream::take_chunks() {
  if (!sink_) return {};
  if (sent_ == sending_.size()) {
    sending_.clear();
    sent_ = 0;
    if (const std::unique_lock lock(outbox_->mutex, std::try_to_lock); lock.owns_lock())
      sending_.swap(outbox_->ready);
  }
  const std::size_t end = std::min(sending_.size(), sent_ + kMaxChunksATick);
  std::vector<picture_chunk_t> chunks;
  for (; sent_ < end; ++sent_) chunks.push_back(std::move(sending_[sent_]));
  return chunks;
}

}  // namespace tactus::visual
