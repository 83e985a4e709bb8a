// Tests of the arm model of the simulated player: mass, spring, damper and tremor.
#include "scripts/simulated_player/arm.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace tactus::simulated_player;
using Eigen::Vector3d;

namespace {

constexpr double kStep_s = 1e-3;

Vector3d after(Arm& arm, const Vector3d& wanted, const Vector3d& force, double seconds) {
  for (double t = 0; t < seconds; t += kStep_s) arm.step(wanted, force, kStep_s);
  return arm.position_m();
}

}  // namespace

TEST_CASE("A pushed arm deflects like a spring, and returns") {
  Arm arm({}, Vector3d(0.1, 0, 0.2), 1);
  const Vector3d rest = after(arm, {0.1, 0, 0.2}, Vector3d::Zero(), 1);
  CHECK((rest - Vector3d(0.1, 0, 0.2)).norm() < 1e-12);
  // Displacement F / k.
  const Vector3d pushed = after(arm, {0.1, 0, 0.2}, {3, 0, -6}, 3);
  CHECK((pushed - rest - Vector3d(3, 0, -6) / ArmDef{}.stiffness_N_m).norm() < 1e-6);
  CHECK((after(arm, {0.1, 0, 0.2}, Vector3d::Zero(), 3) - rest).norm() < 1e-6);
}

TEST_CASE("The step response of the arm is that of a damped spring-mass system") {
  const ArmDef def{.noise_share = 0};
  Arm arm(def, Vector3d::Zero(), 1);
  arm.step({1e-3, 0, 0}, Vector3d::Zero(), kStep_s);  // the step itself: through the damper it gives the mass a velocity
  const double rate = def.damping_N_s_m / (2 * def.mass_kg);
  const double w = std::sqrt(def.stiffness_N_m / def.mass_kg - rate * rate);
  // x(t) of m x'' + b x' + k x = k w + b w': from 0, at rest, with the impulse b w of the step.
  const double blow = def.damping_N_s_m / def.mass_kg;
  for (int i = 1; i < 1000; ++i) {
    const double t = i * kStep_s, e = std::exp(-rate * t);
    const double x = 1e-3 * (1 - e * std::cos(w * t) + e * std::sin(w * t) * (blow - rate) / w);
    CHECK(std::abs(arm.position_m().x() - x) < 1.5e-5);  // of 1 mm: discretisation error of a step of 1 ms
    arm.step({1e-3, 0, 0}, Vector3d::Zero(), kStep_s);
  }
}

TEST_CASE("The tremor grows with the commanded speed, is zero at rest, and is reproducible from the seed") {
  const auto spread = [](double speed_m_s, std::uint64_t seed) {
    Arm arm({}, Vector3d::Zero(), seed);
    double sum = 0;
    int n = 0;
    for (int i = 0; i < 60'000; ++i) {
      arm.step({speed_m_s * i * kStep_s, 0, 0}, Vector3d::Zero(), kStep_s);
      if (i > 2000) sum += arm.velocity_m_s().y() * arm.velocity_m_s().y(), ++n;
    }
    return std::sqrt(sum / n);
  };
  CHECK(spread(0, 1) == 0);
  CHECK(spread(0.2, 1) == spread(0.2, 1));
  CHECK(spread(0.2, 1) != spread(0.2, 2));
  CHECK(spread(0.4, 1) == Approx(2 * spread(0.2, 1)).epsilon(1e-6));  // linear, with the same random numbers
}
