#include "sync/playout/aligner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace tactus::sync {
namespace {

class Fixed : public Aligner {
 public:
  explicit Fixed(Nanoseconds delay) : delay_(delay) {}
  void add(Nanoseconds) override {}
  Nanoseconds delay() const override { return delay_; }

 private:
  Nanoseconds delay_;
};

// A high quantile of the last events.
class Quantile : public Aligner {
 public:
  void add(Nanoseconds needed) override {
    last_[next_++ % kEvents] = needed;
    filled_ = std::min(filled_ + 1, kEvents);
    sorted_.assign(last_.begin(), last_.begin() + static_cast<std::ptrdiff_t>(filled_));
    const auto at = static_cast<std::ptrdiff_t>(std::ceil(kShare * static_cast<double>(filled_)) - 1);
    std::nth_element(sorted_.begin(), sorted_.begin() + at, sorted_.end());
    delay_ = sorted_[static_cast<std::size_t>(at)];
  }
  Nanoseconds delay() const override { return delay_; }

 private:
  // The target of WebRTC's NetEq (delay_manager.h: quantile 0.95). Of 128 events, six lie above it.
  static constexpr double kShare = 0.95;
  static constexpr std::size_t kEvents = 128;
  std::array<Nanoseconds, kEvents> last_{};
  std::vector<Nanoseconds> sorted_;
  std::size_t next_ = 0, filled_ = 0;
  Nanoseconds delay_{0};
};

constexpr std::array<const char*, 2> kAlignerNames{"fixed", "quantile"};

}  // namespace

std::unique_ptr<Aligner> make_aligner(AlignerKind kind, Nanoseconds fixed) {
  if (kind == AlignerKind::kFixed) return std::make_unique<Fixed>(fixed);
  return std::make_unique<Quantile>();
}

AlignerKind parse_aligner(const std::string& word) {
  for (std::size_t i = 0; i < kAlignerNames.size(); ++i)
    if (word == kAlignerNames[i]) return static_cast<AlignerKind>(i);
  throw std::invalid_argument("there is no aligner \"" + word + "\"; choose fixed or quantile");
}

const char* name_of(AlignerKind kind) { return kAlignerNames[static_cast<std::size_t>(kind)]; }

}  // namespace tactus::sync
