#include "haptic_node/rendering/transient.h"

#include <catch2/catch.hpp>
#include <tactus/presentation_t.hpp>

#include "tests/haptic_node/support/tick.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

const sync::Nanoseconds kUncertain{500'000};

Hit hit(std::int64_t id, double ms) {
  Hit h;
  h.event_id = id;
  h.scheduled = host_ms(ms);
  h.approach_speed_m_s = 0.1;
  h.effective_mass_kg = 0.05;
  h.youngs_modulus_Pa = 70e9;
  return h;
}

}  // namespace

TEST_CASE("A harder material rings at a higher frequency, between rubber and aluminium") {
  const TransientShape shape;
  CHECK(transient_frequency_Hz(1e7, shape) == Approx(30));
  CHECK(transient_frequency_Hz(70e9, shape) == Approx(300));
  CHECK(transient_frequency_Hz(1e3, shape) == Approx(30));
  CHECK(transient_frequency_Hz(200e9, shape) == Approx(300));
  // Halfway on logarithmic scales: sqrt(1e7 * 7e10) Pa rings at sqrt(30 * 300) Hz.
  CHECK(transient_frequency_Hz(std::sqrt(7e17), shape) == Approx(std::sqrt(9000)));
}

TEST_CASE("The first half wave carries the momentum of the hit, up to the limit") {
  TransientShape shape;
  shape.limit_N = 100;
  const Hit h = hit(1, 0);
  const double A = transient_amplitude_N(h, shape);
  // Integral of A sin(2 pi f t) over half a period: A / (pi f).
  CHECK(A / (M_PI * 300) == Approx(0.05 * 0.1));
  shape.limit_N = 3;
  CHECK(transient_amplitude_N(h, shape) == 3);
}

TEST_CASE("A transient is a decaying sinusoid and ends") {
  TransientShape shape;
  Transients transients(shape);
  std::vector<presentation_t> reports;
  Hit soft = hit(1, 10);
  soft.youngs_modulus_Pa = 1e7;
  soft.direction = Vector3d::UnitX();
  transients.schedule(soft, reports);
  const double A = M_PI * 30 * 0.005;
  double peak = 0;
  for (int ms = 0; ms < 300; ++ms) {
    const Vector3d f = transients.step(host_ms(ms), kDt, true, kUncertain, reports);
    const double t = (ms - 10 + 0.5) * 1e-3;
    const double envelope = ms < 10 ? 0 : A * std::exp(-80 * t);
    if (envelope > 0.01)
      CHECK(f.x() == Approx(envelope * std::sin(2 * M_PI * 30 * t)).margin(1e-12));
    else
      CHECK(f.norm() == 0);
    peak = std::max(peak, f.norm());
  }
  // Largest of exp(-80 t) sin(60 pi t): at tan(60 pi t) = 60 pi / 80, t = 6.22 ms, 0.560 A; sampled each ms:
  // within 2 %.
  CHECK(peak == Approx(0.560 * A).epsilon(0.02));
  REQUIRE(reports.size() == 1);
  CHECK(reports[0].presented_ns == sync::to_ns(host_ms(10)));
  CHECK(reports[0].part == presentation_t::TRANSIENT);
}

TEST_CASE("The impulse of a transient is taken back, whole or in part, as the hand felt it") {
  const double share = GENERATE(1.0, 0.3);
  const double modulus_Pa = GENERATE(1e7, 70e9);
  Transients transients(TransientShape{});
  std::vector<presentation_t> reports;
  Hit h = hit(1, 10);
  h.youngs_modulus_Pa = modulus_Pa;
  transients.schedule(h, reports);
  Vector3d felt = Vector3d::Zero();
  double impulse = 0, first = 0;
  for (int ms = 0; ms < 2000; ++ms) {
    transients.add_felt_impulse(kDt * felt);
    impulse += kDt * felt.z();
    if (ms == 40) first = impulse;
    felt = share * transients.step(host_ms(ms), kDt, true, kUncertain, reports);
  }
  // Of the 5 mN s of the hit about a half remains when the ringing has ended; then 5 uN s.
  CHECK(first > share * 0.0004);
  CHECK(std::abs(impulse) < 6e-6);
  CHECK(felt.norm() == 0);
}

TEST_CASE("Every hit has one report: presented, late or dropped") {
  Transients transients(TransientShape{});
  std::vector<presentation_t> reports;
  transients.schedule(hit(1, 100), reports);
  transients.schedule(hit(2, 92), reports);
  transients.schedule(hit(3, 84.9), reports);
  transients.schedule(hit(4, 101), reports);
  transients.step(host_ms(100), kDt, true, kUncertain, reports);
  REQUIRE(reports.size() == 3);
  CHECK(reports[0].outcome == presentation_t::PRESENTED);
  CHECK(reports[1].outcome == presentation_t::LATE);
  CHECK(reports[1].presented_ns == sync::to_ns(host_ms(100)));
  CHECK(reports[2].outcome == presentation_t::DROPPED_LATE);
  CHECK(reports[2].presented_ns == -1);
  CHECK(reports[2].scheduled_ns == sync::to_ns(host_ms(84.9)));
  transients.step(host_ms(101), kDt, true, kUncertain, reports);
  CHECK(reports.size() == 4);
}

TEST_CASE("A thousand simultaneous hits are all reported and stay within the force limit") {
  Transients transients(TransientShape{});
  std::vector<presentation_t> reports;
  for (int i = 0; i < 1000; ++i) transients.schedule(hit(i, 5), reports);
  for (int ms = 5; ms < 50; ++ms)
    CHECK(transients.step(host_ms(ms), kDt, true, kUncertain, reports).norm() <= 3 + 1e-12);
  CHECK(reports.size() == 1000);
}

TEST_CASE("A transient without force on the hand is reported as dropped") {
  Transients transients(TransientShape{});
  std::vector<presentation_t> reports;
  transients.schedule(hit(1, 5), reports);
  CHECK(transients.step(host_ms(5), kDt, false, kUncertain, reports).norm() == 0);
  REQUIRE(reports.size() == 1);
  CHECK(reports[0].outcome == presentation_t::DROPPED_LATE);
}

TEST_CASE("A late transient has its full amplitude or is dropped") {
  // On time up to 7.5 ms, dropped after 15 ms.
  const auto felt = [](double lateness_ms) {
    Transients transients(TransientShape{});
    std::vector<presentation_t> reports;
    transients.schedule(hit(1, 100 - lateness_ms), reports);
    const double force = transients.step(host_ms(100), kDt, true, kUncertain, reports).norm();
    REQUIRE(reports.size() == 1);
    return std::pair(int{reports[0].outcome}, force);
  };
  const auto [outcome, full] = felt(0);
  REQUIRE(full > 0.1);
  CHECK(outcome == presentation_t::PRESENTED);
  CHECK(felt(7.5) == std::pair(int{presentation_t::PRESENTED}, full));
  CHECK(felt(7.6) == std::pair(int{presentation_t::LATE}, full));
  CHECK(felt(15) == std::pair(int{presentation_t::LATE}, full));
  CHECK(felt(15.1) == std::pair(int{presentation_t::DROPPED_LATE}, 0.0));
}
