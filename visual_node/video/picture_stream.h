// Pictures for who looks on from outside, as JPEG files in pieces on the bulk bus. They are made in a thread of
// their own; the loop sends a few pieces a tick, and what is late is left out: neither ever waits for the other.
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
  // A tick sends no more: 16 KiB, 1 MB/s at 60 Hz, so that a burst of them fills no socket.
  static constexpr std::size_t kMaxChunksATick = 16;

  PictureStream();
  ~PictureStream();
  // Pictures of that size from now on, as the settings say; the stream is off while `stream` is 0.
  void begin(int width, int height, const Settings& settings);
  // The picture of the tick at `now` can be read: takes it when one is due and there is room. sim_time_ns: which
  // instant it shows, -1: none. presented: when it was out.
  void add(sync::HostTime now, std::int64_t sim_time_ns, sync::HostTime presented,
           const std::function<void(std::span<std::uint8_t>)>& read);
  // What is to be sent in this tick.
  std::vector<picture_chunk_t> take_chunks();
  // Pictures that were made and not sent because the one before was still on its way.
  std::int64_t dropped() const;

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
