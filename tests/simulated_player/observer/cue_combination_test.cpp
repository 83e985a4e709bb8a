#include "scripts/simulated_player/observer/cue_combination.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "scripts/simulated_player/observer/hearing.h"

namespace tactus::observer {

TEST_CASE("Cues combine in proportion to their reliability") {
  const std::array cues{Cue{1, 1}, Cue{0, 4}};  // standard deviations 1 and 2
  CHECK(combine(cues).value == Approx(0.8).epsilon(1e-12));
  CHECK(std::sqrt(combine(cues).variance) == Approx(0.89443).epsilon(1e-5));
}

TEST_CASE("A cue without information does not count") {
  const std::array cues{Cue{3, 2}, Cue{100, std::numeric_limits<double>::infinity()}};
  CHECK(combine(cues).value == 3);
  CHECK(combine(cues).variance == 2);
  CHECK(std::isinf(combine({}).variance));
}

TEST_CASE("The age of a cue lowers its weight when the thing moves") {
  // Vision 3 mm and 100 ms, proprioception 10 mm and 60 ms.
  const auto weight = [](double q) {
    const double v = aged_variance_m2(0.003, 0.100, q), p = aged_variance_m2(0.010, 0.060, q);
    return (1 / v) / (1 / v + 1 / p);
  };
  CHECK(weight(0) == Approx(0.9174).margin(5e-5));
  CHECK(weight(1e-4) == Approx(0.8480).margin(5e-5));
  CHECK(weight(1e-3) == Approx(0.5948).margin(5e-5));
  CHECK(weight(1e-2) == Approx(0.4096).margin(5e-5));
}

TEST_CASE("Causal inference gives the values computed from the equations of Koerding et al.") {
  // Standard deviations 9.2 (sound), 2.14 (sight) and 12.3 (places) degrees, prior 0.28; the sound is at 0.
  const double rows[][4]{
      {5, 0.35671, 1.64476, 4.76672}, {10, 0.27165, 2.50515, 9.57463}, {20, 0.07093, 1.30814, 19.34368}};
  for (const auto& row : rows) {
    const auto r = infer_cause({0, 9.2 * 9.2}, {row[0], 2.14 * 2.14}, 12.3 * 12.3, 0.28);
    CHECK(r.common == Approx(row[1]).margin(5e-6));
    CHECK(r.a == Approx(row[2]).margin(5e-6));
    CHECK(r.b == Approx(row[3]).margin(5e-6));
  }
}

TEST_CASE("Distant cues have separate causes, without a number that is not finite") {
  const auto r = infer_cause({-1e4, 1}, {1e4, 1}, 100, 0.5);
  CHECK(r.common == 0);
  CHECK(std::isfinite(r.a));
  CHECK(infer_cause({0, 1}, {50, 1}, 100, 1).common == 1);
  CHECK(infer_cause({0, 1}, {0, 1}, 100, 0).common == 0);
  CHECK(infer_cause({2, 1}, {0, std::numeric_limits<double>::infinity()}, 1, 0.5).a == Approx(1));
}

TEST_CASE("A sound two seconds after an impact is another event, one within 50 ms is the same") {
  const PlayerParameters player;
  CHECK(same_event_probability(player, 0.05, 0.005, 0.03) > 0.7);
  CHECK(same_event_probability(player, 2, 0.005, 0.03) < 1e-6);
}

}  // namespace tactus::observer
