#include "audio_node/scrapes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "audio_node/sliding.h"
#include "lcmtypes/vectors.h"

using namespace tactus;
using namespace tactus::audio;

namespace {

constexpr double kRate_Hz = 48000, kWave_m = 0.002, kHigh_m = 0.0002;

HeightMap waves() {
  HeightMap map{32, 2, 65535, {}};
  for (int i = 0; i < 64; ++i)
    map.levels.push_back(static_cast<std::uint16_t>(
        std::lround(65535 * (0.5 + 0.5 * std::sin(2 * std::numbers::pi * (i % 32 + 0.5) / 32)))));
  return map;
}

material_def_t rough() {
  material_def_t m{};
  m.friction_static = m.friction_dynamic = 0.5;
  m.bump_asset = 1, m.bump_size_u_m = m.bump_size_v_m = kWave_m, m.bump_height_m = kHigh_m;
  return m;
}

sync::HostTime at_ms(double ms) { return sync::host_time(static_cast<std::int64_t>(1e9 + 1e6 * ms)); }

// A second of a contact that slides along u at a speed, told every millisecond with places that jitter.
std::vector<float> heard(const Relief& relief, double speed_m_s, float level, double told_ms = 1000) {
  Scrapes scrapes(kRate_Hz);
  std::vector<float> stereo(2 * 48000);
  for (int ms = 0; ms < 1000; ++ms) {
    if (ms < told_ms) {
      Scrape s;
      s.id = 3, s.at = at_ms(ms), s.relief = &relief;
      const double x = speed_m_s * (ms + (ms % 3 == 0 ? 1 : 0)) * 1e-3;  // now and then a tick ahead
      s.u = x / kWave_m, s.u_per_s = speed_m_s / kWave_m, s.along_u = 1;
      s.travelled_m = x, s.speed_m_s = speed_m_s, s.level = level, s.left = 1, s.right = 0.5;
      scrapes.take(s);
    }
    scrapes.render(&stereo[static_cast<std::size_t>(96 * ms)], 48, at_ms(ms));
  }
  return stereo;
}

// Amplitude at a frequency of the left channel from 0.2 s to 0.8 s.
double amplitude(const std::vector<float>& stereo, double frequency_Hz) {
  std::complex<double> sum = 0;
  const int from = 9600, n = 28800;
  for (int i = 0; i < n; ++i)
    sum += static_cast<double>(stereo[static_cast<std::size_t>(2 * (from + i))]) *
           std::polar(1.0, -2 * M_PI * frequency_Hz * i / kRate_Hz);
  return 2 * std::abs(sum) / n;
}

contact_t sliding(double speed_m_s, double force_N, const Eigen::Vector3d& place) {
  contact_t c{};
  c.contact_id = 5, c.body_a = 0, c.body_b = 1, c.material_a = 0, c.material_b = 1, c.tool = 0;
  c.normal = to_vec3f(Eigen::Vector3d::UnitZ());
  c.normal_force_N = static_cast<float>(force_N);
  c.sliding_velocity_m_s = to_vec3f(Eigen::Vector3d(0, speed_m_s, 0));  // world; the board is turned by 90 degrees
  c.point_count = 1, c.points.resize(1);
  c.points[0].a_body_m = to_vec3f(place);
  return c;
}

scene_t board() {
  scene_t s{};
  s.listener = to_pose(Eigen::Isometry3d::Identity());
  s.bodies.resize(2), s.body_count = 2;
  s.bodies[0].is_static = 1, s.bodies[1].id = 1;
  s.bodies[0].pose = to_pose(Eigen::Isometry3d(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ())));
  s.materials = {rough(), material_def_t{}}, s.material_count = 2;
  s.materials[1].friction_dynamic = 0.5;
  return s;
}

}  // namespace

TEST_CASE("What scrapes sounds as the slope of the relief under it, at the speed with which it slides") {
  const Relief relief = make_relief(waves(), rough());
  const double speed = GENERATE(0.05, 0.2, 0.5), slope = M_PI * kHigh_m / kWave_m;
  const auto sound = heard(relief, speed, 0.1f);
  const double tone_Hz = speed / kWave_m;
  // Central differences and linear interpolation over 32 pixels a wave lose 1 %, the jitter some more.
  CHECK(amplitude(sound, tone_Hz) == Approx(0.1 * slope).epsilon(0.05));
  CHECK(amplitude(sound, 1.4 * tone_Hz) < 0.05 * 0.1 * slope);
  CHECK(sound[30001] == Approx(sound[30000] / 2));  // its direction
}

TEST_CASE("A scrape that is told of no more fades, and ends") {
  const Relief relief = make_relief(waves(), rough());
  const auto sound = heard(relief, 0.1, 0.1f, 500);
  double before = 0, after = 0, step = 0;
  for (int i = 20000; i < 24000; ++i) before = std::max(before, std::abs(static_cast<double>(sound[2 * i])));
  for (int i = 28800; i < 48000; ++i) after = std::max(after, std::abs(static_cast<double>(sound[2 * i])));
  for (int i = 1; i < 48000; ++i)
    step = std::max(step, std::abs(static_cast<double>(sound[2 * i] - sound[2 * i - 2])));
  CHECK(before > 0.02);
  CHECK(after < 1e-6);
  CHECK(step < 0.01);  // no click: 50 Hz of 0.03 and a roughness of a tenth of it
}

TEST_CASE("Roughness is the same in every run, and of unit mean square") {
  double square = 0, mean = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double r = roughness(i * 1.3e-5);
    square += r * r / 100'000, mean += r / 100'000;
    REQUIRE(std::abs(r) <= 2.2);
  }
  CHECK(square == Approx(1).epsilon(0.05));
  CHECK(std::abs(mean) < 0.05);
  CHECK(roughness(0.123) == roughness(0.123));
}

TEST_CASE("Contacts that slide over a map are told with the place in it, and louder with the power of friction") {
  HeardReliefs reliefs;
  const scene_t scene = board();
  Sliding slides(scene, {{1, waves()}}, reliefs, Settings{});
  const auto all = slides.scrapes({sliding(0.1, 2, {0.005, 0.003, 0})}, at_ms(0), 0.001);
  CHECK(slides.any());
  REQUIRE(all.size() == 1);
  const Scrape s = all[0];
  CHECK(s.u == Approx(0.005 / kWave_m));
  CHECK(s.v == Approx(0.003 / kWave_m));
  CHECK(s.u_per_s == Approx(0.1 / kWave_m));  // +y of the world is +x of the board
  CHECK(std::abs(s.v_per_s) < 1e-4);
  CHECK(s.along_u == Approx(1));
  CHECK(s.level == Approx(Settings{}.scrape_level * std::sqrt(0.5 * 2 * 0.1)));
  CHECK(slides.scrapes({sliding(0.1, 8, {0.005, 0.003, 0})}, at_ms(1), 0.001)[0].level == Approx(2 * s.level));
  CHECK(slides.scrapes({sliding(0.0001, 8, {0.005, 0.003, 0})}, at_ms(2), 0.001).empty());
  SECTION("where nothing has a map, nothing is heard") {
    scene_t plain = scene;
    plain.materials[0].bump_asset = 0;
    Sliding silent(plain, {}, reliefs, Settings{});
    CHECK_FALSE(silent.any());
    CHECK(silent.scrapes({sliding(0.1, 2, {0, 0, 0})}, at_ms(0), 0.001).empty());
  }
  SECTION("a friction map changes the level where it changes") {
    scene_t mapped = scene;
    material_def_t& m = mapped.materials[0];
    m.bump_asset = 0;
    m.friction_asset = 2, m.friction_size_u_m = m.friction_size_v_m = 0.4, m.friction_black = 0.25,
    m.friction_white = 4;
    const HeightMap halves{2, 2, 255, {0, 255, 0, 255}};
    Sliding both(mapped, {{2, halves}}, reliefs, Settings{});
    const float black = both.scrapes({sliding(0.1, 2, {0.1, 0, 0})}, at_ms(0), 0.001)[0].level;
    const float white = both.scrapes({sliding(0.1, 2, {0.3, 0, 0})}, at_ms(1), 0.001)[0].level;
    // Of a pair the root of 16 counts, and of power the root again.
    CHECK(white == Approx(2 * black));
    CHECK(both.scrapes({sliding(0.1, 2, {0.1, 0, 0})}, at_ms(0), 0.001)[0].relief == nullptr);
  }
}
