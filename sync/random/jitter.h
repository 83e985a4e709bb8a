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
  // uniform: half width around the constant delay; normal: standard deviation; pareto: mean of the added delay; s.
  double scale_s = 0;
  // Correlation of consecutive delays in the normal domain, 0 .. < 1: a first-order process whose marginal distribution stays
  // that of the shape.
  double correlation = 0;
  // Added delays of a trace, s, used cyclically.
  std::vector<double> trace_s{};
  // True: messages that arrive in order leave in order, as in a queue.
  bool keep_order = true;
};

// Tail index of the Pareto shape, shifted to begin at 0 (Lomax 1954); design: a heavy tail with finite variance.
inline constexpr double kParetoIndex = 2.5;

class Jitter {
 public:
  explicit Jitter(JitterDef def) : def_(std::move(def)) {}

  // The next delay on top of the constant one, may be negative. u: uniform in (0, 1), drawn for it.
  Nanoseconds next(double u);
  bool keeps_order() const { return def_.keep_order; }

 private:
  JitterDef def_;
  bool started_ = false;
  double z_ = 0;  // of the process, standard normal
  std::size_t trace_index_ = 0;
};

}  // namespace tactus::sync
