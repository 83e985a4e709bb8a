#include "audio_node/spatial/panning.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/audio_node/support/kemar.h"

using namespace tactus::audio;
using test::towards;

namespace {

std::vector<double> gains(const Panning& panning, const Eigen::Vector3f& direction) {
  std::vector<float> g(static_cast<std::size_t>(panning.channels()));
  panning.gains(direction, g.data());
  return {g.begin(), g.end()};
}

// Direction of the gains: the sum of the directions of the loudspeakers (Pulkki 1997, eq. 4).
Eigen::Vector3d pointed(const Layout& layout, const std::vector<double>& g) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < g.size(); ++i)
    if (layout[i]) sum += g[i] * *layout[i];
  return sum.normalized();
}

// All in single precision, with bases no worse than a triangle at 10 degrees: 1e-4.
constexpr double kRounding = 1e-4;

}  // namespace

TEST_CASE("Gains are never negative, have power 1 and point to the source") {
  const auto [name, elevations] = GENERATE(table<std::string, std::vector<double>>(
      {{"quad", {0}}, {"5.1", {0}}, {"cube", {-90, -60, -35.2644, -10, 0, 20, 45, 80, 90}}}));
  const Layout layout = load_layout(name);
  const Panning panning(layout);
  for (const double elevation : elevations)
    for (double azimuth = -180; azimuth < 180; azimuth += 3) {
      INFO(name << " azimuth " << azimuth << ", elevation " << elevation);
      const auto g = gains(panning, towards(azimuth, elevation));
      double power = 0;
      for (const double x : g) {
        CHECK(x >= 0);
        power += x * x;
      }
      CHECK(power == Approx(1).margin(kRounding));
      CHECK((pointed(layout, g) - towards(azimuth, elevation).cast<double>()).norm() < kRounding);
    }
}

TEST_CASE("A source in the direction of a loudspeaker comes from it alone") {
  const std::string name = GENERATE("stereo", "quad", "5.1", "cube");
  const Layout layout = load_layout(name);
  const Panning panning(layout);
  for (std::size_t i = 0; i < layout.size(); ++i) {
    if (!layout[i]) continue;
    const auto g = gains(panning, layout[i]->cast<float>());
    INFO(name << " channel " << i);
    CHECK(g[i] == Approx(1).margin(kRounding));
  }
}

TEST_CASE("The channel of a subwoofer stays silent") {
  const Panning panning(load_layout("5.1"));
  for (double azimuth = -180; azimuth < 180; azimuth += 3) CHECK(gains(panning, towards(azimuth))[3] == 0);
}

TEST_CASE("A source in a gap of the loudspeakers moves over its rim without a jump") {
  // A pair in front; a ring without height; a dome without floor; two; one.
  const std::string csv =
      GENERATE("left,30,0\nright,-30,0\n", "a,45,0\nb,-45,0\nc,135,0\nd,-135,0\n",
               "a,45,0\nb,-45,0\nc,135,0\nd,-135,0\ntop,0,90\n", "a,0,0\nb,0,60\n", "a,10,20\n");
  const Layout layout = parse_layout("channel,azimuth_deg,elevation_deg\n" + csv, "test");
  const Panning panning(layout);
  const double elevation = GENERATE(-80.0, -30.0, 0.0, 30.0, 80.0);
  std::vector<double> before;
  for (double azimuth = -180; azimuth <= 180; azimuth += 0.25) {
    const auto g = gains(panning, towards(azimuth, elevation));
    double power = 0, jump = 0;
    for (std::size_t i = 0; i < g.size(); ++i) {
      CHECK(g[i] >= 0);
      power += g[i] * g[i];
      if (!before.empty()) jump = std::max(jump, std::abs(g[i] * g[i] - before[i] * before[i]));
    }
    INFO(csv << azimuth << ", elevation " << elevation);
    CHECK(power == Approx(1).margin(kRounding));
    // A quarter of a degree is 1/360 of the smallest arc of a gap of 90 degrees; powers change at most 12 times as
    // fast.
    CHECK(jump < 0.035);
    before = g;
  }
}
