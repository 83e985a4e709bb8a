// One step of the explicit Runge-Kutta pair of orders 5 and 4 of Dormand and Prince (Hairer, Norsett and Wanner 1993,
// "Solving Ordinary Differential Equations I", table II.5.2), for an autonomous system y' = f(y).
#pragma once

#include <array>
#include <vector>

namespace tactus::sim::articulated {

class DormandPrince {
 public:
  explicit DormandPrince(std::size_t size) : trial_(size), error_(size) {
    for (auto& slope : slopes_) slope.resize(size);
  }

  // Slope f(y) at the start of the next step. accept() sets it to the slope at the end of the step.
  std::vector<double>& slope() { return slopes_[0]; }
  void accept() { slopes_[0].swap(slopes_[6]); }

  // Evaluates f(y, slope) six times, the last time at the result.
  template <class F>
  void attempt(F&& f, const std::vector<double>& y, double h) {
    static constexpr double a[6][6] = {
        {1.0 / 5},
        {3.0 / 40, 9.0 / 40},
        {44.0 / 45, -56.0 / 15, 32.0 / 9},
        {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
        {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
        {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84},
    };
    // Weights of order 5 minus those of order 4.
    static constexpr double e[7] = {71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                    -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
    const std::size_t n = y.size();
    for (std::size_t stage = 0; stage < 6; ++stage) {
      for (std::size_t i = 0; i < n; ++i) {
        double sum = 0;
        for (std::size_t k = 0; k <= stage; ++k) sum += a[stage][k] * slopes_[k][i];
        trial_[i] = y[i] + h * sum;
      }
      f(trial_, slopes_[stage + 1]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < 7; ++k) sum += e[k] * slopes_[k][i];
      error_[i] = h * sum;
    }
  }

  const std::vector<double>& result() const { return trial_; }
  // Error estimate of the step, per component.
  const std::vector<double>& error() const { return error_; }

 private:
  std::array<std::vector<double>, 7> slopes_;
  std::vector<double> trial_, error_;
};

}  // namespace tactus::sim::articulated
