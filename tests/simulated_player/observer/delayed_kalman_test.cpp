#include "scripts/simulated_player/observer/delayed_kalman.h"

#include <catch2/catch.hpp>
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

TEST_CASE("A filter whose sizes differ is refused") {
  CHECK_THROWS_AS(DelayedKalman(test_model(), Vector::Zero(3), Matrix::Identity(3, 3)), std::invalid_argument);
}

}  // namespace tactus::observer
