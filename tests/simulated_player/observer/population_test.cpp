#include "scripts/simulated_player/observer/population.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "scripts/simulated_player/observer/sobol.h"

namespace tactus::observer {
namespace {

double correlation_of_logs(double PlayerParameters::*a, double PlayerParameters::*b) {
  double sa = 0, sb = 0, aa = 0, bb = 0, ab = 0;
  constexpr int kPlayers = 1024;
  for (std::uint32_t i = 0; i < kPlayers; ++i) {
    const PlayerParameters p = player_of(i, 7);
    const double x = std::log(p.*a), y = std::log(p.*b);
    sa += x, sb += y, aa += x * x, bb += y * y, ab += x * y;
  }
  const double n = kPlayers;
  return (ab - sa * sb / n) / std::sqrt((aa - sa * sa / n) * (bb - sb * sb / n));
}

}  // namespace

TEST_CASE("Every property of the published list has a range with a unit and a source") {
  std::set<int> rows;
  for (const auto& r : parameter_ranges()) {
    rows.insert(r.row);
    CHECK(std::string(r.unit) != "");
    CHECK(std::string(r.source) != "");
    CHECK(r.low < r.high);
  }
  CHECK(rows.size() == 25);
  CHECK(*rows.begin() == 1);
  CHECK(*rows.rbegin() == 25);
  CHECK(parameter_ranges().size() + 2 <= static_cast<std::size_t>(kMaxSobolDimensions));
}

TEST_CASE("The quantile functions give the published 5 %, 50 % and 95 % points, and no player lies outside them") {
  for (const auto& r : parameter_ranges()) {
    INFO(r.name);
    double last = -1e300;
    for (double u : {0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0}) {
      const double value = value_at(r, u);
      CHECK(value > last);
      last = value;
    }
    if (r.spread == Spread::kBeta44) continue;
    CHECK(value_at(r, 0) == Approx(r.to_si * r.low).epsilon(1e-3).margin(1e-9));
    CHECK(value_at(r, 1) == Approx(r.to_si * r.high).epsilon(1e-3).margin(1e-9));
    if (r.spread == Spread::kLogNormal || r.spread == Spread::kPiecewise)
      CHECK(value_at(r, 0.5) == Approx(r.to_si * r.centre).epsilon(1e-9).margin(1e-12));
  }
}

TEST_CASE("The median of a property lies in the middle of a population, and the typical player is the median") {
  const PlayerParameters typical;
  for (const auto& r : parameter_ranges()) {
    INFO(r.name);
    int below = 0;
    for (std::uint32_t i = 0; i < 256; ++i) below += player_of(i, 3).*r.field < value_at(r, 0.5);
    // A property of its own is balanced; one with a common factor deviates by chance.
    CHECK(below >= 108);
    CHECK(below <= 148);
    if (r.spread == Spread::kLogNormal || r.spread == Spread::kPiecewise || r.spread == Spread::kNormal)
      CHECK(typical.*r.field == Approx(value_at(r, 0.5)).epsilon(1e-9).margin(1e-12));
  }
}

TEST_CASE(
    "Latencies of one player correlate with 0.6, noise levels with 0.3, and other properties do not correlate") {
  using P = PlayerParameters;
  // Tolerance: three standard errors of a correlation of 1,024 players, 3 / sqrt(1024), rounded up; the spread of
  // the two-sided log-normal distributions lowers a correlation by less than 0.02.
  CHECK(correlation_of_logs(&P::visual_latency_s, &P::touch_latency_s) == Approx(0.6).margin(0.1));
  CHECK(correlation_of_logs(&P::visual_sd_deg, &P::azimuth_sd_deg) == Approx(0.3).margin(0.1));
  CHECK(correlation_of_logs(&P::visual_latency_s, &P::mass_kg) == Approx(0).margin(0.1));
}

TEST_CASE("A player depends on its number and the seed only") {
  for (const auto& r : parameter_ranges()) CHECK(player_of(17, 5).*r.field == player_of(17, 5).*r.field);
  CHECK(player_of(17, 5).caution != player_of(17, 6).caution);
  CHECK(player_of(17, 5).caution != player_of(18, 5).caution);
}

}  // namespace tactus::observer
