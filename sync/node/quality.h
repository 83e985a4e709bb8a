// A quality ladder. A renderer whose time budget runs short switches to a cheaper step before it misses a tick, and returns
// to a better step after it has had time to spare for long. Pure. Realtime-safe: yes.
//
//   QualityLadder ladder(4, budget, ticks_of_2_s);
//   ladder.add(used);            // once a tick: the time that rendering with ladder.step() took
//   render_with(ladder.step());  // 0: full quality
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "sync/time/time.h"

namespace tactus::sync {

class QualityLadder {
 public:
  static constexpr int kMaxSteps = 8;
  static constexpr std::size_t kWindow = 32;  // design: half a second of pictures
  // The ladder acts on a clear overload, of more than every second tick, after this number of ticks of a step; on a beginning
  // overload, of every fourth tick, after a window. One outlier is neither.
  static constexpr std::size_t kMinTicks = 8;
  // Shares of the budget. Down: before the budget is missed. Up: with room for the expected extra cost of the better step.
  static constexpr double kHigh = 0.85, kLow = 0.7;  // design
  // design: two seconds of pictures
  static constexpr int kCalmTicks = 120;
  // Number of calm periods after which a better step is tried although its measured cost does not fit: the load may have
  // ended since.
  static constexpr int kTryAfter = 4;
  // Length of the trial of a better step, in calm periods. A step that is left within its trial doubles the time until the
  // next trial; each trial that it passes halves that time.
  static constexpr int kTrial = 8;
  // 2^10 of 2 s is half an hour.
  static constexpr int kMaxDoublings = 10;

  // steps: 1 .. kMaxSteps, clamped. budget: the time that a tick may take. calm_ticks: number of ticks in a row with time to
  // spare after which a better step is considered.
  QualityLadder(int steps, Nanoseconds budget, int calm_ticks = kCalmTicks);

  // Starts at the best step that is not overloaded by its measured cost, or at the cheapest measured one. costs: the time of a tick at the
  // steps 0, 1, ...; may end early; further ones are ignored. Call it before the first tick.
  void start(std::span<const Nanoseconds> costs);
  // Once a tick.
  void add(Nanoseconds used);
  // The step to render with, 0 .. steps - 1; 0: full quality.
  int step() const { return step_; }
  int steps() const { return steps_; }
  // Above the share of the budget at which a step is left.
  bool too_long(Nanoseconds used) const;

 private:
  // The duration that this number of quarters of the ticks in the window did not exceed.
  Nanoseconds quartile(std::size_t quarters) const;
  bool overloaded() const;
  void measure_cost();
  void switch_to(int to);
  void postpone_trial();

  int steps_;
  Nanoseconds budget_;
  int calm_ticks_;
  int step_ = 0;
  std::array<Nanoseconds, kWindow> used_{};  // of the step in use, as a ring
  std::size_t count_ = 0;
  std::array<Nanoseconds, kMaxSteps> left_at_{};  // upper quartile of a step when it was left for a cheaper one
  std::array<double, kMaxSteps> ratio_{};  // measured cost of a step relative to the next cheaper one
  int fits_ = 0, spare_ = 0;  // ticks in a row: the better step is expected to fit; the current one has time to spare
  int on_trial_ = 0;          // ticks of the trial of a better step; 0: no trial
  int doublings_ = 0;
};

}  // namespace tactus::sync
