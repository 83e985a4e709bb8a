// A quality ladder: a sense that is about to need more time than it has renders with a cheaper step instead,
// before it misses; and with a better one again when it has long had time to spare. Pure. Realtime-safe: yes.
//
//   QualityLadder ladder(4, budget, ticks_of_2_s);
//   ladder.add(used);            // once a tick, what rendering with ladder.step() took
//   render_with(ladder.step());  // 0: full quality
#pragma once

#include <array>
#include <cstddef>

#include "sync/time/time.h"

namespace tactus::sync {

class QualityLadder {
 public:
  static constexpr int kMaxSteps = 8;
  static constexpr std::size_t kWindow = 32;  // design: half a second of pictures
  // A clear overload, of more than every second tick, is acted on after so many ticks of a step; a beginning one,
  // of every fourth, after a window. One outlier is neither.
  static constexpr std::size_t kLeastTicks = 8;
  // Shares of the budget. Down: before the budget is missed; up: with room for what the better step is expected to
  // take more.
  static constexpr double kHigh = 0.85, kLow = 0.7;  // design
  // design: two seconds of pictures
  static constexpr int kCalmTicks = 120;
  // A better step that is not expected to fit, by what it took when it was left, is tried after so many calm times
  // anyway: the load may have gone while the step was changed.
  static constexpr int kTryAfter = 4;
  // A better step that is left again within its trial, of so many calm times, doubles the time until the next;
  // each trial time that it holds halves it again.
  static constexpr int kTrial = 8;
  // 2^10 of 2 s is half an hour.
  static constexpr int kMaxDoublings = 10;

  // steps: 1 .. kMostSteps, what is outside is clamped. budget: what a tick may take. calm_ticks: time to spare
  // for so many ticks is long.
  QualityLadder(int steps, Nanoseconds budget, int calm_ticks = kCalmTicks);

  // Once a tick.
  void add(Nanoseconds used);
  // The step to render with, 0 .. steps - 1; 0: full quality.
  int step() const { return step_; }
  int steps() const { return steps_; }

 private:
  // That many quarters of the ticks of the window took no longer.
  Nanoseconds quartile(std::size_t quarters) const;
  bool overloaded() const;
  void learn();
  void go(int to);
  void wait_for_better();

  int steps_;
  Nanoseconds budget_;
  int calm_ticks_;
  int step_ = 0;
  std::array<Nanoseconds, kWindow> used_{};  // of the step in use, in a ring
  std::size_t count_ = 0;
  std::array<Nanoseconds, kMaxSteps> left_at_{};  // upper quartile of a step when it was left for a cheaper one
  std::array<double, kMaxSteps> ratio_{};  // cost of a step to that of the next cheaper one, as learnt then
  int fits_ = 0, spare_ = 0;  // ticks in a row: the better step should fit; this one has time to spare
  int on_trial_ = 0;          // ticks of the trial of a better step; 0: none is
  int doublings_ = 0;
};

}  // namespace tactus::sync
