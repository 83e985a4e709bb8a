#include "audio_node/signal/weighted_tail.h"

#include <Eigen/Core>

namespace tactus::audio {
namespace {

constexpr int kStates = static_cast<int>(AWeighting::kStates);
// Doublings of the length of the sum: 2^40 samples, after which the slowest pole (20.6 Hz) has decayed at any
// rate.
constexpr int kDoublings = 40;

using Matrix = Eigen::Matrix<double, kStates, kStates>;
using Vector = Eigen::Matrix<double, kStates, 1>;

Vector state_of(const AWeighting& filter) { return Vector::Map(filter.state().data()); }

}  // namespace

WeightedTail::WeightedTail(double rate_Hz) {
  // Each column from the response to one unit.
  Matrix a;
  Vector c;
  for (int i = 0; i < kStates; ++i) {
    AWeighting filter(rate_Hz);
    AWeighting::State unit{};
    unit[static_cast<std::size_t>(i)] = 1;
    filter.set_state(unit);
    c[i] = filter.next(0);
    a.col(i) = state_of(filter);
  }
  AWeighting filter(rate_Hz);
  const double d = filter.next(1);
  const Vector b = state_of(filter);

  Matrix w = c * c.transpose(), power = a;
  for (int i = 0; i < kDoublings; ++i) {
    w += (power.transpose() * w * power).eval();
    power = (power * power).eval();
  }
  const Vector slope = a.transpose() * w * b + d * c;
  for (int i = 0; i < kStates; ++i) {
    slope_[static_cast<std::size_t>(i)] = slope[i];
    for (int k = 0; k < kStates; ++k) gramian_[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] = w(i, k);
  }
  square_ = b.dot(w * b) + d * d;
}

double WeightedTail::energy(const AWeighting& filter) const {
  double sum = 0;
  for (std::size_t i = 0; i < kSize; ++i)
    for (std::size_t k = 0; k < kSize; ++k) sum += filter.state()[i] * gramian_[i][k] * filter.state()[k];
  return sum > 0 ? sum : 0;
}

double WeightedTail::slope(const AWeighting& filter) const {
  double sum = 0;
  for (std::size_t i = 0; i < kSize; ++i) sum += slope_[i] * filter.state()[i];
  return sum;
}

}  // namespace tactus::audio
