// Reduction of the message rate of tool motion by a Weber deadband.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>
#include <sstream>

#include "sync/degradation/deadband.h"

using namespace tactus::sync;

namespace {

struct Stroke {
  double rate_Hz;
  std::vector<Eigen::Vector3d> position_m;
};

// A minimum-jerk stroke of 15 cm back and forth in 1.5 s with 0.1 mm of tremor at 9 Hz (Flash and Hogan 1985; physiological tremor of the
// hand lies at 8 to 12 Hz), 1 kHz.
Stroke generated() {
  Stroke s{1000, {}};
  for (int i = 0; i < 6000; ++i) {
    const double t = i / 1000.0, phase = std::fmod(t, 1.5) / 0.75, u = phase < 1 ? phase : 2 - phase;
    const double way = u * u * u * (10 - 15 * u + 6 * u * u);
    s.position_m.push_back({0.15 * way, 1e-4 * std::sin(2 * std::numbers::pi * 9 * t), 0});
  }
  return s;
}

Stroke recorded(const std::filesystem::path& file) {
  Stroke s{100, {}};
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);  // time_s,x_m,y_m,z_m,...
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    double t;
    Eigen::Vector3d p;
    if (words >> t >> p.x() >> p.y() >> p.z()) s.position_m.push_back(p);
  }
  return s;
}

struct Saved {
  double sent_share = 0;
  double worst = 0;  // largest change that was held back, in units of the band
};

// Deadband on velocity, as in the profile "10% velocity floor=5mm/s".
Saved run(const Stroke& stroke, double fraction) {
  constexpr double kFloor_m_s = 0.005;
  Deadband deadband({.fraction = fraction, .quantity = Quantity::kVelocity, .floor = kFloor_m_s});
  Saved out;
  Eigen::Vector3d sent = Eigen::Vector3d::Zero();
  const std::size_t n = stroke.position_m.size() - 1;
  for (std::size_t i = 0; i < n; ++i) {
    const Signal s{1, Quantity::kVelocity, (stroke.position_m[i + 1] - stroke.position_m[i]) * stroke.rate_Hz};
    const bool send = deadband.send(SimTime(from_seconds(static_cast<double>(i) / stroke.rate_Hz)), {&s, 1}, 0);
    if (send) sent = s.value;
    out.sent_share += static_cast<double>(send) / static_cast<double>(n);
    out.worst = std::max(out.worst, (s.value - sent).norm() / std::max(fraction * sent.norm(), kFloor_m_s));
  }
  return out;
}

}  // namespace

TEST_CASE("A deadband of 10 % saves most messages of a stroke at 1 kHz, within the deadband error") {
  const Saved tenth = run(generated(), 0.1), fifth = run(generated(), 0.2);
  INFO("sent " << 100 * tenth.sent_share << " % at 10 %, " << 100 * fifth.sent_share << " % at 20 %");
  // Each half stroke crosses levels a factor 1.1 apart twice between the floor and its peak of 1.875 * 0.15 m / 0.75 s (Flash and Hogan
  // 1985). The tremor of 5.7 mm/s crosses the floor at most 18 times per second in each direction.
  const double levels = 2 * std::log(0.375 / 0.05) / std::log(1.1) + 2 * 0.05 / 0.005;
  CHECK(tenth.sent_share < (levels / 0.75 + 36) / 1000);
  CHECK(fifth.sent_share < tenth.sent_share);
  CHECK(tenth.worst <= 1);
  CHECK(fifth.worst <= 1);
}

TEST_CASE("A deadband of 10 % saves messages of recorded tool motions") {
  const char* data = std::getenv("TACTUS_DATA");
  if (!data) return;  // the recordings lie beside the source tree and may be absent
  for (const char* name : {"grating_a.csv", "grating_b.csv"}) {
    const Stroke stroke = recorded(std::filesystem::path(data) / "tool_motion" / name);
    REQUIRE(stroke.position_m.size() > 1000);
    const Saved tenth = run(stroke, 0.1);
    std::cout << name << ": " << 100 * tenth.sent_share << " % of " << stroke.position_m.size()
              << " messages sent\n";
    CHECK(tenth.sent_share < 1);
    CHECK(tenth.worst <= 1);
    CHECK(run(stroke, 0.3).sent_share < tenth.sent_share);
  }
}
