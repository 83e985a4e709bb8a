// Random delays with a given distribution and correlation. Pure.
#pragma once

#include <utility>
#include <vector>

#include "sync/time/time.h"

namespace tactus::sync {

enum class JitterShape { kUniform, kNormal, kPareto, kTrace };

// The jitter of a profile: "3ms normal", "10ms uniform", "2ms pareto correlation=0.5", "trace=FILE".
struct JitterDef {
  JitterShape shape = JitterShape::kUniform;
  // uniform: half width around the constant delay; normal: standard deviation; pareto: mean of the added delay; s. The first
  // two need a constant delay: needed_delay_s().
  double scale_s = 0;
  // Correlation of consecutive delays in the normal domain, 0 .. < 1: a first-order process whose marginal distribution stays
  // that of the shape.
  double correlation = 0;
  // Added delays of a trace, s, used cyclically.
  std::vector<double> trace_s{};
  // True: a snapshot that is overtaken by a newer one is dropped, so that snapshots leave in the order of their arrival. Its
  // delay is never changed for that: a queue, in which each item waits for the one before, would add to mean and deviation.
  bool keep_order = true;
};

struct DelayMoments {
  double mean_s = 0, sd_s = 0;
};

// The least constant delay, s, at which the jitter keeps its mean and deviation: no item can leave before it arrives, so
// smaller delays would be cut off at 0. uniform: its half width; normal: three standard deviations; the others only add: 0.
double needed_delay_s(const JitterDef&);
// Mean and standard deviation, s, of Jitter::next() with this limit.
DelayMoments moments(const JitterDef&, double limit_s);
// Mean and standard deviation, s, of uniform or normal jitter without a constant delay, where half of the delays are 0.
DelayMoments moments_cut_at_zero(const JitterDef&);

// Tail index of the Pareto shape, shifted to begin at 0 (Lomax 1954); design: a heavy tail with finite variance.
inline constexpr double kParetoIndex = 2.5;

class Jitter {
 public:
  // limit: uniform and normal delays lie between -limit and limit, so that the mean stays 0. Design: the constant delay.
  explicit Jitter(JitterDef def, Nanoseconds limit = Nanoseconds::max()) : def_(std::move(def)), limit_(limit) {}

  // The next delay on top of the constant one, may be negative. u: uniform in (0, 1), drawn for it.
  Nanoseconds next(double u);
  bool keeps_order() const { return def_.keep_order; }

 private:
  JitterDef def_;
  Nanoseconds limit_;
  bool started_ = false;
  double z_ = 0;  // of the process, standard normal
  std::size_t trace_index_ = 0;
};

}  // namespace tactus::sync
