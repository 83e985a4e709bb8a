#include "scripts/simulated_player/observer/delayed_kalman.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace tactus::observer {

DelayedKalman::DelayedKalman(HandModel model, const Vector& mean, const Matrix& covariance, double memory_s)
    : model_(std::move(model)) {
  const auto n = mean.size();
  if (n < 2 || model_.a.rows() != n || model_.a.cols() != n || model_.b.size() != n || model_.noise.rows() != n ||
      model_.noise.cols() != n || covariance.rows() != n || covariance.cols() != n)
    throw std::invalid_argument(
        "delayed_kalman: sizes of state, model and covariance differ; give all the same number of states");
  if (!(model_.dt_s > 0) || !(memory_s >= 0))
    throw std::invalid_argument("delayed_kalman: the step must be positive and the memory not negative");
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k)
      if (model_.a(i, k) != 0) elements_.push_back({i, k, model_.a(i, k)});
  ring_.assign(static_cast<std::size_t>(std::ceil(memory_s / model_.dt_s)) + 1, {mean, covariance, mean, covariance, 0, 0, {}});
  next_ = ring_.front();
}

void DelayedKalman::apply(Step& step) const {
  step.updated_mean = step.mean;
  step.updated_covariance = step.covariance;
  const int n = static_cast<int>(step.mean.size());
  Vector& mean = step.updated_mean;
  Matrix& covariance = step.updated_covariance;
  for (const Measurement& m : step.measurements) {
    std::array<double, kMaxStates> ph{};
    double variance = m.variance, difference = m.y;
    for (int k = 0; k < n; ++k) {
      if (m.h[k] == 0) continue;
      for (int i = 0; i < n; ++i) ph[static_cast<std::size_t>(i)] += covariance(i, k) * m.h[k];
      difference -= m.h[k] * mean[k];
    }
    for (int k = 0; k < n; ++k) variance += m.h[k] * ph[static_cast<std::size_t>(k)];
    for (int j = 0; j < n; ++j) {
      const double gain = ph[static_cast<std::size_t>(j)] / variance;
      mean[j] += gain * difference;
      for (int i = 0; i < n; ++i) covariance(i, j) -= gain * ph[static_cast<std::size_t>(i)];
    }
  }
}

// A P A' + noise + input B B'. A is sparse, and P is symmetric; a fixed size takes a third of the time.
template <int N>
void DelayedKalman::advance_covariance(const Matrix& from, double input, Matrix& to) const {
  using Square = Eigen::Matrix<double, N, N>;
  const Eigen::Map<const Square> p(from.data());
  Square pa = Square::Zero();
  for (const Element& e : elements_) pa.col(e.row) += e.value * p.col(e.column);
  const Square ap = pa.transpose();
  Eigen::Map<Square> result(to.data());
  result = Eigen::Map<const Square>(model_.noise.data());
  for (const Element& e : elements_) result.col(e.row) += e.value * ap.col(e.column);
  const Eigen::Map<const Eigen::Matrix<double, N, 1>> b(model_.b.data());
  for (int j = 0; j < N; ++j)
    if (b[j] != 0) result.col(j) += input * b[j] * b;
}

void DelayedKalman::advance(const Step& from, Step& to) const {
  const double u = from.u;
  to.mean = model_.b * u;
  for (const Element& e : elements_) to.mean[e.row] += e.value * from.updated_mean[e.column];
  const double input = model_.control_share * model_.control_share * u * u + model_.control_sd * model_.control_sd + from.input_sd * from.input_sd;
  const auto covariance = [&]<int N>() { advance_covariance<N>(from.updated_covariance, input, to.covariance); };
  switch (from.mean.size()) {
    case 2: covariance.operator()<2>(); break;
    case 3: covariance.operator()<3>(); break;
    case 4: covariance.operator()<4>(); break;
    case 5: covariance.operator()<5>(); break;
    case 6: covariance.operator()<6>(); break;
    case 7: covariance.operator()<7>(); break;
    default: covariance.operator()<kMaxStates>(); break;
  }
  to.covariance(0, 0) += model_.speed_noise_m2_s * std::abs(from.updated_mean[1]) * model_.dt_s;
}

void DelayedKalman::refresh() {
  for (; dirty_ < size_; ++dirty_) {
    if (dirty_ > 0) advance(at(dirty_ - 1), at(dirty_));
    apply(at(dirty_));
  }
}

void DelayedKalman::predict(double u, double input_sd) {
  refresh();
  Step& from = at(size_ - 1);
  from.u = u;
  from.input_sd = input_sd;
  advance(from, next_);
  next_.updated_mean = next_.mean;
  next_.updated_covariance = next_.covariance;
  next_.measurements.clear();
  if (size_ < ring_.size())
    ++size_;
  else
    oldest_ = (oldest_ + 1) % ring_.size();
  std::swap(at(size_ - 1), next_);
  dirty_ = size_;
}

std::size_t DelayedKalman::index_of(double age_s) const {
  const auto back = static_cast<std::size_t>(std::lround(std::max(0.0, age_s) / model_.dt_s));
  return back >= size_ ? 0 : size_ - 1 - back;
}

void DelayedKalman::measure(double age_s, const Vector& h, double y, double variance) {
  if (h.size() != next_.mean.size())
    throw std::invalid_argument("delayed_kalman: a measurement has another number of states than the model; give one row of it");
  if (!std::isfinite(y) || !std::isfinite(variance) || !std::isfinite(age_s) || variance <= 0) return;
  if (age_s > static_cast<double>(ring_.size() - 1) * model_.dt_s) ++too_old_;
  const std::size_t index = index_of(age_s);
  at(index).measurements.push_back({h, y, variance});
  dirty_ = std::min(dirty_, index);
}

const Vector& DelayedKalman::mean() {
  refresh();
  return at(size_ - 1).updated_mean;
}

const Matrix& DelayedKalman::covariance() {
  refresh();
  return at(size_ - 1).updated_covariance;
}

Vector DelayedKalman::mean_before(double age_s) {
  refresh();
  return at(index_of(age_s)).updated_mean;
}

}  // namespace tactus::observer
