#include "scripts/simulated_player/observer/delayed_kalman.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace tactus::observer {

DelayedKalman::DelayedKalman(HandModel model, const Vector& mean, const Matrix& covariance, double memory_s)
    : model_(std::move(model)), steps_(0), dirty_(0) {
  const auto n = mean.size();
  if (n < 2 || model_.a.rows() != n || model_.a.cols() != n || model_.b.size() != n || model_.noise.rows() != n ||
      model_.noise.cols() != n || covariance.rows() != n || covariance.cols() != n)
    throw std::invalid_argument(
        "delayed_kalman: sizes of state, model and covariance differ; give all the same number of states");
  if (!(model_.dt_s > 0) || !(memory_s >= 0))
    throw std::invalid_argument("delayed_kalman: the step must be positive and the memory not negative");
  steps_ = static_cast<std::size_t>(std::ceil(memory_s / model_.dt_s)) + 1;
  history_.push_back({mean, covariance, mean, covariance, 0, 0, {}});
}

void DelayedKalman::apply(Step& step) const {
  step.updated_mean = step.mean;
  step.updated_covariance = step.covariance;
  for (const Measurement& m : step.measurements) {
    const Vector ph = step.updated_covariance * m.h;
    const Vector gain = ph / (m.h.dot(ph) + m.variance);
    step.updated_mean += gain * (m.y - m.h.dot(step.updated_mean));
    step.updated_covariance -= gain * ph.transpose();
  }
}

void DelayedKalman::advance(const Step& from, Step& to) const {
  const double u = from.u;
  to.mean = model_.a * from.updated_mean + model_.b * u;
  to.covariance = model_.a * from.updated_covariance * model_.a.transpose() + model_.noise;
  const double input = model_.control_share * model_.control_share * u * u + model_.control_sd * model_.control_sd + from.input_sd * from.input_sd;
  to.covariance += input * model_.b * model_.b.transpose();
  to.covariance(0, 0) += model_.speed_noise_m2_s * std::abs(from.updated_mean[1]) * model_.dt_s;
}

void DelayedKalman::refresh() {
  for (; dirty_ < history_.size(); ++dirty_) {
    if (dirty_ > 0) advance(history_[dirty_ - 1], history_[dirty_]);
    apply(history_[dirty_]);
  }
}

void DelayedKalman::predict(double u, double input_sd) {
  refresh();
  history_.back().u = u;
  history_.back().input_sd = input_sd;
  Step next;
  advance(history_.back(), next);
  next.updated_mean = next.mean;
  next.updated_covariance = next.covariance;
  history_.push_back(std::move(next));
  if (history_.size() > steps_) history_.pop_front();
  dirty_ = history_.size();
}

std::size_t DelayedKalman::index_of(double age_s) const {
  const auto back = static_cast<std::size_t>(std::lround(std::max(0.0, age_s) / model_.dt_s));
  return back >= history_.size() ? 0 : history_.size() - 1 - back;
}

void DelayedKalman::measure(double age_s, const Vector& h, double y, double variance) {
  if (!std::isfinite(y) || !std::isfinite(variance) || !std::isfinite(age_s) || variance <= 0) return;
  if (age_s > static_cast<double>(steps_ - 1) * model_.dt_s) ++too_old_;
  const std::size_t at = index_of(age_s);
  history_[at].measurements.push_back({h, y, variance});
  dirty_ = std::min(dirty_, at);
}

const Vector& DelayedKalman::mean() {
  refresh();
  return history_.back().updated_mean;
}

const Matrix& DelayedKalman::covariance() {
  refresh();
  return history_.back().updated_covariance;
}

Vector DelayedKalman::mean_before(double age_s) {
  refresh();
  return history_[index_of(age_s)].updated_mean;
}

}  // namespace tactus::observer
