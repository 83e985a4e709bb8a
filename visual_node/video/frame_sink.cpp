#include "visual_node/video/frame_sink.h"

#include <utility>

namespace tactus::visual {

FrameSink::FrameSink(std::size_t capacity, std::size_t bytes, std::function<bool(const Picture&)> consume,
                     std::function<void()> at_end)
    : consume_(std::move(consume)), at_end_(std::move(at_end)) {
  for (std::size_t i = 0; i < capacity; ++i) empty_.push_back({.rgba = std::vector<std::uint8_t>(bytes)});
  thread_ = std::thread([this] { run(); });
}

FrameSink::~FrameSink() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

std::optional<Picture> FrameSink::take_empty() {
  const std::lock_guard lock(mutex_);
  if (ended_ || empty_.empty()) return std::nullopt;
  Picture p = std::move(empty_.back());
  empty_.pop_back();
  return p;
}

void FrameSink::push(Picture picture) {
  {
    const std::lock_guard lock(mutex_);
    full_.push_back(std::move(picture));
  }
  changed_.notify_one();
}

bool FrameSink::ended() const {
  const std::lock_guard lock(mutex_);
  return ended_;
}

void FrameSink::run() {
  for (;;) {
    Picture p;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return closing_ || !full_.empty(); });
      if (full_.empty()) break;
      p = std::move(full_.front());
      full_.pop_front();
    }
    const bool go_on = consume_(p);
    const std::lock_guard lock(mutex_);
    empty_.push_back(std::move(p));
    if (!go_on) {
      ended_ = true;
      break;
    }
  }
  at_end_();
}

}  // namespace tactus::visual
