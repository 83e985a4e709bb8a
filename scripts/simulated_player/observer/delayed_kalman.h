// Kalman filter of a linear system whose measurements arrive late and in any order. The filter keeps the last
// steps with their inputs and measurements. A measurement that claims an age is applied at that age, and the later
// steps are computed again: the result equals that of a filter which received all measurements in time. Pure.
#pragma once

#include <vector>

#include "scripts/simulated_player/observer/matrices.h"

namespace tactus::observer {

// One step of dt_s: x' = A x + B u, with noise that the player assumes.
struct HandModel {
  double dt_s = 0.01;
  Matrix a;
  Vector b;
  Matrix noise;              // covariance for each step, apart from the two below
  double control_share = 0;  // standard deviation of the input noise for each step, as a share of |u|
  double control_sd = 0;     // its constant part, in the unit of u
  // Diffusion of state 0 for each unit of |state 1|, m^2/s at 1 m/s: a fast movement is less certain.
  double speed_noise_m2_s = 0;
};

class DelayedKalman {
 public:
  // memory_s: the largest age of a measurement; an older one is applied at that age. Throws std::invalid_argument
  // when a size does not fit, or a state count exceeds kMaxStates.
  DelayedKalman(HandModel model, const Vector& mean, const Matrix& covariance, double memory_s = 0.6);

  // One step with this input, and a standard deviation of the input in this step beside those of the model.
  void predict(double u, double input_sd = 0);
  // A scalar measurement y = h x + noise of this variance, which the player believes to be age_s old. Ignored when
  // y or the variance is not finite. Negative ages count as 0. Throws std::invalid_argument when the size of h is not
  // that of the state.
  void measure(double age_s, const Vector& h, double y, double variance);
  // The estimate at the newest step, or age_s before it.
  const Vector& mean();
  const Matrix& covariance();
  Vector mean_before(double age_s);
  // Number of measurements that were older than the memory.
  long too_old() const { return too_old_; }

 private:
  struct Measurement {
    Vector h;
    double y, variance;
  };
  struct Step {
    Vector mean;        // before this step's measurements
    Matrix covariance;  // before them
    Vector updated_mean;
    Matrix updated_covariance;
    double u = 0;  // input to the next step
    double input_sd = 0;
    std::vector<Measurement> measurements;
  };
  // An element of A that is not zero.
  struct Element {
    int row, column;
    double value;
  };
  void apply(Step& step) const;
  void advance(const Step& from, Step& to) const;
  template <int N>
  void advance_covariance(const Matrix& from, double input, Matrix& to) const;
  void refresh();
  std::size_t index_of(double age_s) const;
  // Step 0 is the oldest.
  Step& at(std::size_t index) {
    const std::size_t i = oldest_ + index;
    return ring_[i < ring_.size() ? i : i - ring_.size()];
  }

  HandModel model_;
  std::vector<Element> elements_;
  std::vector<Step> ring_;  // as many steps as the memory holds
  Step next_;
  std::size_t oldest_ = 0, size_ = 1;
  std::size_t dirty_ = 0;  // first step to compute again
  long too_old_ = 0;
};

}  // namespace tactus::observer
