#include "scripts/simulated_player/observer/delayed_kalman.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "scripts/simulated_player/observer/noise_stream.h"

namespace tactus::observer {
namespace {

HandModel test_model() {
  HandModel m;
  m.dt_s = 0.01;
  m.a = Matrix::Identity(2, 2);
  m.a(0, 1) = m.dt_s;
  m.b = Vector::Zero(2);
  m.b[1] = m.dt_s;
  m.noise = Matrix::Identity(2, 2) * 1e-6;
  m.control_share = 0.1;
  return m;
}

DelayedKalman test_filter(double memory_s = 0.6) {
  return {test_model(), Vector::Zero(2), Matrix::Identity(2, 2) * 0.01, memory_s};
}

Vector place_row() {
  Vector h = Vector::Zero(2);
  h[0] = 1;
  return h;
}

}  // namespace

TEST_CASE("Late measurements in any order give the estimate of a filter that received them in time") {
  NoiseStream noise(1, 1);
  for (int round = 0; round < 20; ++round) {
    DelayedKalman in_time = test_filter(), late = test_filter();
    struct Late {
      int made, due;
      double y;
    };
    std::vector<Late> waiting;
    for (int step = 0; step < 80; ++step) {
      const double y = noise.normal(0.1), u = noise.normal();
      in_time.measure(0, place_row(), y, 0.01);
      waiting.push_back({step, step + static_cast<int>(noise.uniform() * 40), y});
      for (const Late& m : waiting)
        if (m.due == step) late.measure((step - m.made) * 0.01, place_row(), m.y, 0.01);
      in_time.predict(u);
      late.predict(u);
    }
    for (const Late& m : waiting)
      if (m.due >= 80) late.measure((80 - m.made) * 0.01, place_row(), m.y, 0.01);
    // Equal up to rounding.
    CHECK((in_time.mean() - late.mean()).norm() < 1e-12);
    CHECK((in_time.covariance() - late.covariance()).norm() < 1e-12);
  }
}

TEST_CASE("A wrongly believed age misplaces a moving thing by speed times error") {
  Vector start = Vector::Zero(2);
  start[1] = 0.5;
  HandModel model = test_model();
  model.noise.setZero();
  DelayedKalman filter(model, start, Matrix::Identity(2, 2) * 1e-6);
  // The picture is 200 ms old; the player believes 100 ms.
  for (int step = 0; step < 200; ++step) {
    filter.measure(0.1, place_row(), 0.5 * 0.01 * (step - 20), 1e-8);
    filter.predict(0);
  }
  CHECK(0.5 * 0.01 * 200 - filter.mean()[0] == Approx(0.5 * 0.1).margin(0.005));
}

TEST_CASE("The filter ignores measurements that are not finite and counts those older than its memory") {
  DelayedKalman filter = test_filter(0.1);
  for (int i = 0; i < 50; ++i) filter.predict(0);
  const Vector before = filter.mean();
  filter.measure(0, place_row(), std::numeric_limits<double>::quiet_NaN(), 1);
  filter.measure(0, place_row(), 1, std::numeric_limits<double>::infinity());
  filter.measure(std::numeric_limits<double>::infinity(), place_row(), 1, 1);
  filter.measure(0, place_row(), 1, 0);
  CHECK(filter.mean() == before);
  CHECK(filter.too_old() == 0);
  filter.measure(0.5, place_row(), 1, 1);
  CHECK(filter.too_old() == 1);
  CHECK(filter.mean().allFinite());
}

TEST_CASE("A fast movement is less certain than a slow one") {
  HandModel model = test_model();
  model.speed_noise_m2_s = 1e-3;
  Vector fast = Vector::Zero(2);
  fast[1] = 1;
  DelayedKalman moves(model, fast, Matrix::Zero(2, 2)), rests(model, Vector::Zero(2), Matrix::Zero(2, 2));
  moves.predict(0), rests.predict(0);
  CHECK(moves.covariance()(0, 0) - rests.covariance()(0, 0) == Approx(1e-3 * 0.01));
}

TEST_CASE("A filter of any size equals the textbook equations of a dense model") {
  NoiseStream noise(2, 1);
  for (int n = 2; n <= kMaxStates; ++n) {
    HandModel model;
    const auto random = [&] { return noise.uniform() < 0.4 ? 0.0 : noise.normal(0.5); };
    model.a = Matrix::NullaryExpr(n, n, random);
    model.b = Vector::NullaryExpr(n, random);
    model.noise = Matrix::Identity(n, n) * 0.1;
    model.control_share = 0.3, model.control_sd = 0.2, model.speed_noise_m2_s = 0.5;
    Vector mean = Vector::NullaryExpr(n, random);
    Matrix covariance = Matrix::Identity(n, n);
    DelayedKalman filter(model, mean, covariance);
    for (int step = 0; step < 20; ++step) {
      const Vector h = Vector::NullaryExpr(n, random);
      const double y = noise.normal(), u = noise.normal(), sd = noise.uniform();
      filter.measure(0, h, y, 0.5);
      filter.predict(u, sd);
      const Vector gain = covariance * h / (h.dot(covariance * h) + 0.5);
      mean += gain * (y - h.dot(mean));
      covariance = ((Matrix::Identity(n, n) - gain * h.transpose()) * covariance).eval();
      const double input = 0.3 * 0.3 * u * u + 0.2 * 0.2 + sd * sd, diffusion = 0.5 * std::abs(mean[1]) * model.dt_s;
      mean = (model.a * mean + model.b * u).eval();
      covariance = (model.a * covariance * model.a.transpose() + model.noise + input * model.b * model.b.transpose()).eval();
      covariance(0, 0) += diffusion;
      INFO(n << " states, step " << step);
      REQUIRE((filter.mean() - mean).norm() <= 1e-9 * (1 + mean.norm()));
      REQUIRE((filter.covariance() - covariance).norm() <= 1e-9 * covariance.norm());
    }
  }
}

TEST_CASE("A filter without memory applies a late measurement to its only step") {
  DelayedKalman filter = test_filter(0);
  for (int i = 0; i < 5; ++i) filter.predict(1);
  const double before = filter.mean()[0];
  filter.measure(0.3, place_row(), before + 1, 1e-6);
  CHECK(filter.too_old() == 1);
  CHECK(filter.mean()[0] == Approx(before + 1).margin(0.01));
}

TEST_CASE("A filter whose sizes differ is refused") {
  CHECK_THROWS_AS(DelayedKalman(test_model(), Vector::Zero(3), Matrix::Identity(3, 3)), std::invalid_argument);
  DelayedKalman filter = test_filter();
  CHECK_THROWS_AS(filter.measure(0, Vector::Zero(3), 1, 1), std::invalid_argument);
}

}  // namespace tactus::observer
