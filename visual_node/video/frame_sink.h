// Moves finished pictures off the render loop: a bounded queue and a consumer thread of normal priority. A full
// queue drops the new picture; the loop never waits.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace tactus::visual {

struct Picture {
  std::int64_t tick = 0;
  std::int64_t presented_ns = -1;  // time of presentation, for reports
  std::vector<std::uint8_t> rgba;  // sRGB, the lowest row first
};

class FrameSink {
 public:
  // consume runs in the sink's thread; when it returns false the sink accepts no more pictures. at_end runs there
  // too, last.
  FrameSink(
      std::size_t capacity, std::size_t bytes, std::function<bool(const Picture&)> consume,
      std::function<void()> at_end = [] {});
  // Consumes the queued pictures, then ends.
  ~FrameSink();
  FrameSink(const FrameSink&) = delete;
  FrameSink& operator=(const FrameSink&) = delete;

  // Returns an empty picture to fill; nothing when the queue is full or the sink has ended. Thread-safe: yes.
  std::optional<Picture> take_empty();
  void push(Picture picture);
  bool ended() const;

 private:
  void run();
  std::function<bool(const Picture&)> consume_;
  std::function<void()> at_end_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Picture> empty_;
  std::deque<Picture> full_;
  bool closing_ = false, ended_ = false;
  std::thread thread_;
};

}  // namespace tactus::visual
