#include "audio_node/modal/measured_modes.h"

#include <catch2/catch.hpp>
#include <numbers>
#include <tactus/body_def_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/measured_mode_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>

#include "audio_node/excitation/impact.h"

using namespace tactus;
using namespace tactus::audio;

namespace {

// A bell of three modes on body 1, which would otherwise sound as a steel bar; body 0 is a floor.
scene_t scene(std::vector<measured_mode_t> modes) {
  scene_t s{};
  material_def_t steel{}, bell{};
  steel.youngs_modulus_Pa = 2e11, steel.poissons_ratio = 0.29, steel.density_kg_m3 = 7850;
  bell = steel;
  bell.modes = std::move(modes), bell.mode_count = static_cast<int>(bell.modes.size());
  s.materials = {steel, bell}, s.material_count = 2;
  for (const int id : {0, 1}) {
    body_def_t body{};
    body.id = id, body.tool = -1, body.mass_kg = 0.353, body.pose.orientation.w = 1;
    shape_def_t shape{};
    shape.body = id, shape.kind = shape_def_t::BOX, shape.size_m = {0.3, 0.03, 0.005}, shape.material = id;
    shape.pose.orientation.w = 1;
    s.bodies.push_back(body), s.shapes.push_back(shape);
  }
  s.body_count = s.shape_count = 2;
  s.listener.orientation.w = 1;
  return s;
}

Impacts impacts(std::vector<measured_mode_t> modes, const Settings& settings = {}) {
  return Impacts(
      scene(std::move(modes)), [](std::int64_t) { return std::nullopt; }, settings, 48000, 1);
}

const std::vector<measured_mode_t> kBell{{440, 3, 0.2}, {900, 5, 0.4}, {2300, 12, 0.1}};

}  // namespace

TEST_CASE("A body of a material with measured modes has these modes in their proportions") {
  const Impacts all = impacts(kBell);
  const BodySound& bell = all.body(1);
  REQUIRE(bell.modes.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(bell.modes[i].frequency_Hz == kBell[i].frequency_Hz);
    CHECK(bell.modes[i].damping_1_s == kBell[i].damping_1_s);
    CHECK(bell.modes[i].gain == Approx(kBell[i].amplitude / 0.4));
  }
  SECTION("a body of another material sounds by its shape") { CHECK(all.body(0).modes.size() > 3); }
}

TEST_CASE("Measured modes sound in the proportions of the recording at any struck place") {
  const Impacts all = impacts(kBell);
  // The unit gain of mode_step makes each a unit of velocity: gains over it are pressures.
  const auto pressures = [&](const BodyPlace& place) {
    const PerMode gains = all.gains(1, place);
    std::array<double, 3> p{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double lost = kBell[i].damping_1_s / (2 * std::numbers::pi);
      const double damped = std::sqrt(kBell[i].frequency_Hz * kBell[i].frequency_Hz - lost * lost);
      p[i] = static_cast<double>(gains[i]) /
             static_cast<double>(mode_step(damped, kBell[i].damping_1_s, 48000).unit_gain);
    }
    return p;
  };
  const auto middle = pressures({{0, 0, 0.0025}, {0, 0, -1}}), end = pressures({{0.15, 0, 0.0025}, {0, 0, -1}});
  CHECK(middle == end);
  // Gains are single precision.
  CHECK(middle[0] / middle[1] == Approx(0.5).epsilon(1e-6));
  CHECK(middle[2] / middle[1] == Approx(0.25).epsilon(1e-6));
}

TEST_CASE("The strongest of too many measured modes are kept, and inaudible ones are omitted") {
  Settings settings;
  settings.max_modes = 2;
  std::vector<measured_mode_t> modes = kBell;
  modes.insert(modes.begin(), {25, 1, 9});  // below lowest_frequency
  modes.push_back({19'000, 1, 9});          // above highest_frequency
  const Impacts all = impacts(modes, settings);
  REQUIRE(all.body(1).modes.size() == 2);
  CHECK(all.body(1).modes[0].frequency_Hz == 440);
  CHECK(all.body(1).modes[1].frequency_Hz == 900);
  SECTION("a body with only inaudible measured modes sounds by its shape") {
    CHECK(impacts({{25, 1, 9}}).body(1).modes.size() > 1);
  }
}
