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

// Mean plus four mean deviations (Ramjee, Kurose, Towsley, Schulzrinne 1994, algorithm 1), each an exponential average with
// the gain 1/16 of RFC 3550, section 6.4.1: contacts happen about ten times a second, unlike speech packets, which arrive
// every 20 ms.
class MovingAverage : public Aligner {
 public:
  void add(Nanoseconds needed) override {
    const auto n = static_cast<double>(needed.count());
    if (!begun_) mean_ = n;
    begun_ = true;
    mean_ += kGain * (n - mean_);
    deviation_ += kGain * (std::abs(n - mean_) - deviation_);
  }
  Nanoseconds delay() const override { return Nanoseconds(std::llround(mean_ + kDeviations * deviation_)); }

 private:
  static constexpr double kGain = 1.0 / 16;
  static constexpr double kDeviations = 4;
  double mean_ = 0, deviation_ = 0;
  bool begun_ = false;
};

// Virtual-time rendering (after Ishibashi and Tasaka 1995): the target moves later by the lateness of an event, at most one
// step at a time, and earlier by one step when all events of a run had more room than that. The step sizes and the run length
// are design.
class VirtualTime : public Aligner {
 public:
  void add(Nanoseconds needed) override {
    if (!begun_) target_ = needed + kMargin;
    begun_ = true;
    const Nanoseconds late = needed - target_;
    if (late > Nanoseconds(0)) {
      target_ += std::min(late, kStepLater);
      room_ = Nanoseconds::max();
      run_ = 0;
      return;
    }
    room_ = std::min(room_, -late);
    if (++run_ < kRun) return;
    if (room_ > kMargin) target_ -= std::min(room_ - kMargin, kStepEarlier);
    room_ = Nanoseconds::max();
    run_ = 0;
  }
  Nanoseconds delay() const override { return target_; }

 private:
  static constexpr Nanoseconds kMargin{2'000'000};       // design: jitter of a paced loop without priority
  static constexpr Nanoseconds kStepLater{10'000'000};   // design: followed at a slew of 5 % within 0.2 s
  static constexpr Nanoseconds kStepEarlier{2'000'000};  // design: returning to a smaller delay is not urgent
  static constexpr int kRun = 32;                        // design: this number of events in time before it moves earlier
  Nanoseconds target_{0}, room_{Nanoseconds::max()};
  int run_ = 0;
  bool begun_ = false;
};

constexpr std::array<const char*, 4> kNames{"fixed", "quantile", "average", "virtual-time"};

}  // namespace

std::unique_ptr<Aligner> make_aligner(AlignerKind kind, Nanoseconds fixed) {
  switch (kind) {
    case AlignerKind::kFixed: return std::make_unique<Fixed>(fixed);
    case AlignerKind::kMovingAverage: return std::make_unique<MovingAverage>();
    case AlignerKind::kVirtualTime: return std::make_unique<VirtualTime>();
    case AlignerKind::kQuantile: break;
  }
  return std::make_unique<Quantile>();
}

AlignerKind parse_aligner(const std::string& word) {
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (word == kNames[i]) return static_cast<AlignerKind>(i);
  throw std::invalid_argument("there is no aligner \"" + word +
                              "\"; choose fixed, quantile, average or virtual-time");
}

const char* name_of(AlignerKind kind) { return kNames[static_cast<std::size_t>(kind)]; }

}  // namespace tactus::sync
