// Streams pictures to observers as JPEG files in pieces on the bulk bus. A separate thread encodes them; the loop
// sends a few pieces a tick, and late pictures are dropped, so that neither waits for the other.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <tactus/picture_chunk_t.hpp>
#include <vector>

#include "sync/time/time.h"
#include "visual_node/settings.gen.h"
#include "visual_node/video/frame_sink.h"
#include "visual_node/video/jpeg.h"

namespace tactus::visual {

inline constexpr int kPictureChunkBytes = 1024;

// The pieces of one picture, in order; the bus fills the header.
std::vector<picture_chunk_t> chunks_of(const Jpeg& jpeg, std::int64_t picture, std::int64_t sim_time_ns,
                                       std::int64_t presented_ns);

class PictureStream {
 public:
  // Limit of the pieces a tick: 16 KiB, 1 MB/s at 60 Hz, so that a burst of them fits into a socket buffer.
  static constexpr std::size_t kMaxChunksATick = 16;

  PictureStream();
  ~PictureStream();
  // Sets the size of the pictures and the settings; the stream is off while `stream` is 0.
  void begin(int width, int height, const Settings& settings);
  // Call when the picture of the tick at `now` can be read: takes it when one is due and the queue has room.
  // sim_time_ns: its instant, -1: none. presented: when it was presented.
  void add(sync::HostTime now, std::int64_t sim_time_ns, sync::HostTime presented,
           const std::function<void(std::span<std::uint8_t>)>& read);
  // The pieces to send in this tick.
  std::vector<picture_chunk_t> take_chunks();

 private:
  struct Outbox;
  std::shared_ptr<Outbox> outbox_;
  std::unique_ptr<FrameSink> sink_;
  sync::Nanoseconds period_{0};
  sync::HostTime next_{};
  std::vector<picture_chunk_t> sending_;
  std::size_t sent_ = 0;
};

}  // namespace tactus::visual
