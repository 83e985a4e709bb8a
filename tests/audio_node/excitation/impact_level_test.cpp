// The level of an impact: its sound pressure.
#include "audio_node/excitation/impact.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>

#include "audio_node/excitation/peak.h"
#include "audio_node/excitation/radiation.h"
#include "lcmtypes/vectors.h"
#include "tests/audio_node/support/impact_scene.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;
using std::numbers::pi;

TEST_CASE("Doubling the impulse doubles the sound pressure") {
  const Impacts all = impacts_of_scene();
  std::mt19937 random(21);
  const auto draw = [&](double from, double to) { return from * std::pow(to / from, std::uniform_real_distribution<double>(0, 1)(random)); };
  int clear = 0, heard = 0;
  for (int i = 0; i < 200; ++i) {
    const int a = static_cast<int>(random() % 5), b = (a + 1 + static_cast<int>(random() % 4)) % 5;
    const double mass = draw(1e-3, 1), speed = draw(0.02, 1), curvature = draw(5, 1000);
    // At twice the speed and twice the curvature the contact time is the same: T ~ (m^2 k / v)^(1/5).
    const Strike once = all.strike(impact_hit(a, b, static_cast<float>(speed), static_cast<float>(mass), static_cast<float>(curvature)), {});
    const Strike twice = all.strike(impact_hit(a, b, static_cast<float>(2 * speed), static_cast<float>(mass), static_cast<float>(2 * curvature)), {});
    CAPTURE(a, b, mass, speed, curvature);
    REQUIRE(twice.impulse_N_s == Approx(2 * once.impulse_N_s));
    const double limit = 4 * Settings{}.reference_level;
    if (peak_Pa(twice, 48000) > 0.99 * limit) continue;  // 12 dB above the reference
    ++clear;
    CHECK(peak_Pa(twice, 48000) / peak_Pa(once, 48000) == Approx(2).epsilon(1e-3));
    // A voice ends below -100 dBFS, which shortens weak sounds, and the limits of peak and level reduce loud ones.
    if (peak_Pa(once, 48000) < 0.01 || peak_Pa(twice, 48000) > 0.25 || i % 5) continue;
    ++heard;
    CHECK(largest_sample(rendered_strike(twice)) / largest_sample(rendered_strike(once)) == Approx(2).epsilon(1e-3));
    CHECK(rms_sample(rendered_strike(twice)) / rms_sample(rendered_strike(once)) == Approx(2).epsilon(1e-3));
  }
  CHECK(clear > 100);
  CHECK(heard > 10);
}

TEST_CASE("The level of an impact is its pressure, in proportion or compressed by loudness_exponent") {
  Settings settings;
  settings.loudness_exponent = GENERATE(1.0, 0.6);
  const Impacts all = impacts_of_scene(settings);
  const auto rendered_peak = [&](const contact_event_t& e) { return largest_sample(rendered_strike(all.strike(e, {}))); };
  // With the same spectrum (same contact time: speed 1 and mass 1 against mass 4 and speed 16, T ~ (m^2/v)^(1/5))
  // the pressure is 64 times as large.
  const double weak = rendered_peak(impact_hit(0, 1, 0.02f, 0.001f)), strong = rendered_peak(impact_hit(0, 1, 0.32f, 0.004f));
  CHECK(strong / weak == Approx(std::pow(64, settings.loudness_exponent)).epsilon(0.02));
  CHECK(all.strike(impact_hit(0, 1, 0.0001f, 1e-6f), {}).min_audible_gain > 1);
  CHECK_FALSE(all.strike(impact_hit(0, 1, 0.5f, 0.1f), {}).min_audible_gain > 1);
}

TEST_CASE("The level of an impact without audible modes is the pressure of the clicks of its two bodies") {
  // Two steel balls of 3 cm and 0.888 kg, whose lowest mode is at 2.645 c_s / (2 pi a) = 44 kHz.
  scene_t s = impact_scene();
  add_shape_body(s, shape_def_t::SPHERE, {0.03, 0, 0}, 0.888, 1);
  const Impacts all(
      s, [](std::int64_t) { return std::nullopt; }, {}, 48000, 1);
  REQUIRE(all.body(2).modes.empty());
  const double mass = 0.444, curvature = 67;
  for (const double speed : {0.05, 0.5}) {
    const double length_s = contact_time_s(mass, curvature, speed, all.body(2).material, all.body(5).material);
    REQUIRE(length_s > 2 / 48000.);
    const double change_m_s = mass * speed * (1 + 0.6) / 0.888;  // restitution 0.6
    const double pressure = 2 * acceleration_peak_Pa(change_m_s, length_s, 0.03);
    CAPTURE(speed, pressure, length_s);
    const Settings settings;
    const Strike strike = all.strike(impact_hit(2, 5, static_cast<float>(speed), static_cast<float>(mass), static_cast<float>(curvature)), {});
    CHECK(peak_Pa(strike, 48000) == Approx(settings.reference_level * pressure / settings.reference_pressure_Pa).epsilon(1e-3));
  }
}

TEST_CASE("Impacts of hard bodies are louder than those of soft ones") {
  const Impacts all = impacts_of_scene();
  const auto rendered_peak = [&](const contact_event_t& e) { return largest_sample(rendered_strike(all.strike(e, {}))); };
  for (const int id : {1, 2, 4}) {
    const double peak = rendered_peak(impact_hit(0, id, 0.5f, static_cast<float>(all.body(id).mass_kg), 100));
    CAPTURE(id, peak);
    CHECK(peak > 0.05);
    CHECK(peak < 0.71);
  }
  SECTION("a rubber ball is much softer: its pulse is too long for modes, and its own jerk is the lower bound") {
    const contact_event_t blow = impact_hit(0, 3, 0.5f, static_cast<float>(all.body(3).mass_kg), 100);
    const double length_s = all.strike(blow, {}).pulse[0].samples / 48000.0;
    REQUIRE(length_s > 0.01);
    const double jerk_Pa = acceleration_peak_Pa(0.5 * 1.6, length_s, 0.05);
    CHECK(rendered_peak(blow) > 0.25 * jerk_Pa / 10);
    CHECK(rendered_peak(blow) < rendered_peak(impact_hit(0, 2, 0.5f, 0.576f, 100)) / 4);
  }
}

TEST_CASE("An impact is never quieter than a slower one of the same bodies, also where repeated collisions set in") {
  const Impacts all = impacts_of_scene();
  std::mt19937 random(13);
  const auto draw = [&](double from, double to) { return from * std::pow(to / from, std::uniform_real_distribution<double>(0, 1)(random)); };
  int repeated = 0, falls = 0;
  double largest_fall = 0;
  for (int i = 0; i < 1500; ++i) {
    const int a = static_cast<int>(random() % 5), b = (a + 1 + static_cast<int>(random() % 4)) % 5;
    const double mass = draw(1e-3, 1), speed = draw(0.02, 5), curvature = draw(5, 2000), faster = speed * (1 + draw(1e-3, 0.5));
    const auto peak = [&](double v) {
      const Strike s = all.strike(impact_hit(a, b, static_cast<float>(v), static_cast<float>(mass), static_cast<float>(curvature)), {});
      repeated += s.pulse[1].samples > 0;
      return peak_Pa(s, 48000);  // as played: its sides are scaled
    };
    const double slow = peak(speed), fast = peak(faster);
    falls += fast < slow * (1 - 1e-3);
    largest_fall = std::max(largest_fall, 1 - fast / slow);
  }
  CAPTURE(largest_fall);
  CHECK(repeated > 300);
  CHECK(falls == 0);
}
