// The send queue of one browser. Bounded: a slow browser loses messages, which are counted and shown, and gets only the
// newest picture. Pure.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace tactus::live {

struct Outgoing {
  std::shared_ptr<const std::string> bytes;
  bool binary = false;
};

class SendQueue {
 public:
  // Design: two seconds of frames, and more than the largest of them.
  static constexpr std::size_t kMaxMessages = 64;
  static constexpr std::size_t kMaxBytes = 4 << 20;

  // Returns false, and counts, when there is no room.
  bool push(std::shared_ptr<const std::string> text) {
    if (texts_.size() >= kMaxMessages || bytes_ + text->size() > kMaxBytes) return ++dropped_, false;
    bytes_ += text->size();
    texts_.push_back(std::move(text));
    return true;
  }
  // Replaces a picture that has not been sent.
  void put_picture(std::shared_ptr<const std::string> picture) {
    if (picture_) ++dropped_pictures_;
    picture_ = std::move(picture);
  }
  // Texts first: they are small, and they control the display.
  std::optional<Outgoing> pop() {
    if (!texts_.empty()) {
      Outgoing next{std::move(texts_.front()), false};
      texts_.pop_front();
      bytes_ -= next.bytes->size();
      return next;
    }
    if (picture_) return Outgoing{std::exchange(picture_, nullptr), true};
    return std::nullopt;
  }
  std::size_t waiting() const { return texts_.size() + (picture_ ? 1 : 0); }
  std::size_t bytes() const { return bytes_; }
  std::int64_t dropped() const { return dropped_; }
  std::int64_t dropped_pictures() const { return dropped_pictures_; }

 private:
  std::deque<std::shared_ptr<const std::string>> texts_;
  std::shared_ptr<const std::string> picture_;
  std::size_t bytes_ = 0;
  std::int64_t dropped_ = 0, dropped_pictures_ = 0;
};

}  // namespace tactus::live
