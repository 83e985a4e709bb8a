#include "audio_node/mixer/scrapes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <tactus/material_def_t.hpp>

#include "tests/audio_node/support/scrape_run.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

const ReliefLevels& wavy() {
  static const ReliefLevels relief(make_relief(waves(), rough()));
  return relief;
}
constexpr double kSlope = M_PI * kHigh_m / kWave_m;
// Of k sin x sqrt(1 + k^2 sin^2 x) the first harmonic is k (1 + 3/8 k^2), except for the fourth power.
constexpr double kTone = kSlope * (1 + 0.375 * kSlope * kSlope);

// Velocity of a unit mass on its spring under a unit force at a frequency.
double driven(double frequency_Hz, double natural_Hz, double damping_1_s) {
  const std::complex<double> iw(0, 2 * M_PI * frequency_Hz);
  const double w0_squared = std::pow(2 * M_PI * natural_Hz, 2) + damping_1_s * damping_1_s;
  return std::abs(iw / (iw * iw + 2 * damping_1_s * iw + w0_squared));
}

}  // namespace

TEST_CASE("The force of a sliding contact follows the slope of the relief at the rate of its waves") {
  const double speed = GENERATE(0.05, 0.2, 0.5);
  const auto r = run_scrape(
      [&](double ms) {
        Scrape s = along_x(&wavy(), speed, ms);
        if (static_cast<int>(ms) % 3 == 0) s.sides[0].place_m.x() += 1e-3 * speed;  // occasionally a tick ahead
        return s;
      },
      1000, 1000);
  const double tone_Hz = speed / kWave_m, should_be = static_cast<double>(kForce) * kTone;
  // Central differences and linear interpolation over 32 pixels a wave lose 1 %, the jitter slightly more.
  CHECK(amplitude(r.force, tone_Hz, 0.2, 0.8) == Approx(should_be).epsilon(0.05));
  CHECK(amplitude(r.force, 1.4 * tone_Hz, 0.2, 0.8) < 0.02 * should_be);
}

TEST_CASE("A slide with updates at 60 Hz is as steady as one with updates at 1 kHz") {
  const auto scrape_at = [](double ms) { return along_x(&wavy(), 0.2, ms); };
  const auto rare = run_scrape(scrape_at, 500, 500, 16).force, often = run_scrape(scrape_at, 500, 500, 1).force;
  float off = 0;
  for (std::size_t n = 0; n < often.size(); ++n) off = std::max(off, std::abs(rare[n] - often[n]));
  // Except for the rounding of places.
  CHECK(off < 1e-5f * kForce);
}

// A contact that speeds up and slows down is updated each millisecond. Blocks end at any sample.
TEST_CASE("The force of a contact does not depend on the instants of the blocks") {
  const int frames = 48 * 300, begin = GENERATE(1, 13, 48, 64);
  const auto force_of = [&](int first_block) {
    auto scrapes = std::make_unique<Scrapes>(kRate);
    auto voices = std::make_unique<Voices>(4, kRate, kRing);
    std::vector<float> force;
    for (int at = 0, block = first_block; at < frames; at += block, block = std::min(64, frames - at)) {
      for (int done = 0; done < block;) {
        const int n = at + done, to_update = 48 - n % 48, some = std::min(block - done, to_update);
        if (n % 48 == 0) {
          const double t = 1e-3 * (n / 48);
          Scrape s = along_x(&wavy(), 0.2, n / 48.);
          s.sides[0].place_m.x() = 0.1 * t - 0.1 * std::sin(20 * t) / 20, s.sides[0].velocity_m_s.x() = 0.1 - 0.1 * std::cos(20 * t);
          scrapes->update(s);
        }
        scrapes->render(done, some, at_ms(n / 48.));
        done += some;
      }
      scrapes->drive(*voices, block);
      const float* f = scrapes->force(3);
      force.insert(force.end(), f, f + block);
    }
    return force;
  };
  const auto whole = force_of(48), other = force_of(begin);
  REQUIRE(whole.size() == other.size());
  for (std::size_t n = 0; n < whole.size(); ++n) REQUIRE(std::abs(whole[n] - other[n]) < 1e-4f * kForce);
}

TEST_CASE("A mode responds as a driven oscillator, loudest where the waves pass at its frequency") {
  const double natural_Hz = 500, damping_1_s = 30;
  const double tone_Hz = GENERATE(250.0, 480.0, 500.0, 520.0, 1000.0);
  const auto r = run_scrape(
      [&](double ms) {
        Scrape s = along_x(&wavy(), tone_Hz * kWave_m, ms);
        give_mode(s.sides[0], natural_Hz, damping_1_s);
        return s;
      },
      1500, 1500);
  // N s a sample, so the same number per second. From 0.5 s on the initial ringing has decayed by exp(-15). A mode
  // that is stepped by impulses differs from one in continuous time by (w / rate)^2 = 2 % at 1 kHz.
  const double ratio = amplitude(r.sound, tone_Hz, 0.5, 1.5) / (kRate * amplitude(r.force, tone_Hz, 0.5, 1.5));
  CHECK(ratio == Approx(driven(tone_Hz, natural_Hz, damping_1_s)).epsilon(0.02));
  if (tone_Hz == natural_Hz) CHECK(ratio == Approx(1 / (2 * damping_1_s)).epsilon(0.01));
}

TEST_CASE("Roughness without a map sounds the same at the same place, and an octave higher at twice the speed") {
  // At these speeds no wave is too short for a sample.
  const auto at = [](double speed_m_s) {
    return run_scrape(
               [=](double ms) {
                 Scrape s = along_x(nullptr, speed_m_s, ms);
                 s.sides[0].roughness.height_m = 3e-6;
                 return s;
               },
               400, 400)
        .force;
  };
  const auto slow = at(0.008), fast = at(0.016);
  CHECK(slow == at(0.008));
  REQUIRE(rms(slow, 0.1, 0.3) > 0);
  double off = 0;
  for (std::size_t n = 4800; n < 9600; ++n)
    off = std::max(off, std::abs(static_cast<double>(fast[n] - slow[2 * n])));
  CHECK(off < 1e-4 * rms(slow, 0.1, 0.3));
}

TEST_CASE("Waves too short for a sample do not alias, neither of a map nor of roughness") {
  material_def_t m = rough();
  m.bump_size_u_m = m.bump_size_v_m = 1e-4;
  m.bump_height_m = 1e-5;
  const ReliefLevels fine(make_relief(waves(), m));
  const auto at = [&](double tone_Hz) {
    return run_scrape([&](double ms) { return along_x(&fine, tone_Hz * 1e-4, ms); }, 200, 200).force;
  };
  CHECK(rms(at(2000), 0.05, 0.2) == Approx(static_cast<double>(kForce) * kTone / std::sqrt(2)).epsilon(0.03));
  // Would alias to 9.6 and 2 kHz.
  CHECK(rms(at(38400), 0.05, 0.2) < 0.01 * rms(at(2000), 0.05, 0.2));
  CHECK(rms(at(46000), 0.05, 0.2) < 0.01 * rms(at(2000), 0.05, 0.2));
  const auto rough_at = [](double speed_m_s) {
    return run_scrape(
               [=](double ms) {
                 Scrape s = along_x(nullptr, speed_m_s, ms);
                 s.sides[0].roughness.height_m = 3e-6;
                 return s;
               },
               500, 500)
        .force;
  };
  // Near half the rate almost nothing, compared with an eighth of the rate. Means over 20 neighbours.
  const auto fast = rough_at(0.5);
  const auto level = [&](double about_Hz) {
    double sum = 0;
    for (int i = 0; i < 20; ++i) sum += std::pow(amplitude(fast, about_Hz + 37 * i, 0.1, 0.5), 2);
    return std::sqrt(sum);
  };
  CHECK(level(22500) < 0.1 * level(5500));
}

TEST_CASE("Rolling filters the profile by a low-pass at the speed over the width of the patch") {
  const double cutoff_Hz = 200, of_cutoff = GENERATE(0.25, 1.0, 2.0, 4.0);
  const double tone_Hz = of_cutoff * cutoff_Hz;
  const auto r = run_scrape(
      [&](double ms) {
        Scrape s = along_x(&wavy(), tone_Hz * kWave_m, ms);
        s.slide = 0, s.roll = kForce, s.cutoff_Hz = cutoff_Hz;
        return s;
      },
      600, 600);
  // Butterworth of second order; 3 % as above.
  CHECK(amplitude(r.force, tone_Hz, 0.2, 0.6) ==
        Approx(static_cast<double>(kForce) * kSlope / std::sqrt(1 + std::pow(of_cutoff, 4))).epsilon(0.03));
}

TEST_CASE("The residual modes of a body follow the force at once, above the highest rendered mode") {
  const double residual_Hz = 400, tone_Hz = GENERATE(100.0, 400.0, 1600.0);
  const auto r = run_scrape(
      [&](double ms) {
        Scrape s = along_x(&wavy(), tone_Hz * kWave_m, ms);
        give_mode(s.sides[0], 400, 60, 0);
        s.sides[0].residual_gain = 0.5f, s.sides[0].residual_Hz = residual_Hz;
        return s;
      },
      400, 400);
  // Butterworth of second order.
  const double ratio = std::pow(tone_Hz / residual_Hz, 2), high = ratio / std::sqrt(1 + ratio * ratio);
  CHECK(amplitude(r.sound, tone_Hz, 0.1, 0.4) ==
        Approx(0.5 * high * amplitude(r.force, tone_Hz, 0.1, 0.4)).epsilon(0.01));
}

TEST_CASE("A friction map changes the strength by the place") {
  material_def_t m{};
  m.friction_size_u_m = m.friction_size_v_m = 0.4, m.friction_black = 0.25, m.friction_white = 4;
  const FrictionMap map(HeightMap{2, 2, 255, {0, 255, 0, 255}}, m);
  const auto loud = [&](double from_m, bool mapped) {
    const auto r = run_scrape(
        [&](double ms) {
          Scrape s = along_x(&wavy(), 0.1, ms);
          s.sides[0].place_m.x() += from_m;
          if (mapped) s.sides[0].friction = &map;
          return s;
        },
        100, 100);
    return rms(r.force, 0.02, 0.1);
  };
  // The middles of black and of white; 10 mm further is a tenth of the way to the other.
  CHECK(loud(0.295, true) == Approx(2 * loud(0.095, true)).epsilon(0.05));
  CHECK(loud(0.295, false) == Approx(loud(0.095, false)).epsilon(0.01));
}

TEST_CASE("A contact that ends is silent 2 ms later without a click, and its bodies ring out") {
  const auto scrape_at = [](double ms) {
    Scrape s = along_x(&wavy(), 0.1, ms);
    s.sides[0].place_m.x() += kWave_m / 4;  // where it is steepest
    give_mode(s.sides[0], 400, 60, 0.5f);
    return s;
  };
  const auto r = run_scrape(scrape_at, 500, 1000);
  // Within a sample the slope changes by its curvature, the strength by its ramp of 2 ms. Steep parts are
  // stronger, by k^2 / 2, which changes by at most 3 k^2 / 2.
  const double tone = 2 * M_PI * 0.1 / kWave_m / kRate, ramp = 1 / (0.002 * kRate);
  double step = std::abs(static_cast<double>(r.force[0]));
  for (std::size_t n = 1; n < r.force.size(); ++n)
    step = std::max(step, std::abs(static_cast<double>(r.force[n] - r.force[n - 1])));
  CHECK(step < (1 + 2 * kSlope * kSlope) * static_cast<double>(kForce) * kSlope * (tone + ramp));
  CHECK(rms(r.force, 0.4, 0.5) > 0);
  for (std::size_t n = 24000 + 96; n < r.force.size(); ++n) REQUIRE(r.force[n] == 0);
  // The sound decays by exp(-60 t), and ends below -100 dBFS: from 0.02 that takes 0.13 s.
  const auto loudest = *std::max_element(r.sound.begin() + 12000, r.sound.begin() + 24000);
  CHECK(loudest > 1e-3f);
  CHECK(loudest < 0.3f);
  for (std::size_t n = 24000 + 14400; n < r.sound.size(); ++n) REQUIRE(r.sound[n] == 0);
}

TEST_CASE("A contact without further updates and without an end is silent after 32 ms") {
  auto scrapes = std::make_unique<Scrapes>(kRate);
  auto voices = std::make_unique<Voices>(4, kRate, kRing);
  scrapes->update(along_x(&wavy(), 0.1, 0));
  for (int ms = 0; ms < 34; ++ms) {
    CHECK(scrapes->active() == (ms < 32 ? 1 : 0));
    scrapes->render(0, 48, at_ms(ms)), scrapes->drive(*voices, 48);
  }
}

TEST_CASE("A change of the place on a body makes no click") {
  // A mode of such a high frequency and damping that it follows the force: its jumps would be audible.
  const double mode_Hz = 9000;
  const auto scrape_at = [&](double ms) {
    Scrape s = along_x(&wavy(), 0.1, ms);
    give_mode(s.sides[0], mode_Hz, mode_Hz, ms < 250 ? 1.f : -1.f);
    return s;
  };
  const auto r = run_scrape(scrape_at, 500, 500);
  double change = 0;
  for (std::size_t n = 11900; n < 14400; ++n)
    change = std::max(change, std::abs(static_cast<double>(r.sound[n] - r.sound[n - 1])));
  // The gains change over a block of 1 ms: beside the tone the factor changes the force by 2 / 48 a sample, of
  // which the displacement of the mode, rate / w at most, is audible. A jump would be 2, a click of 50 times that.
  const double step = 2 / 48. + 2 * M_PI * 50 / kRate;
  CHECK(change <
        (1 + 2 * kSlope * kSlope) * static_cast<double>(kForce) * kSlope * step * kRate / (2 * M_PI * mode_Hz));
}

TEST_CASE("Scrapes with values that are not finite or implausible are ignored") {
  const double bad =
      GENERATE(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300, -1e12);
  const int where = GENERATE(0, 1, 2, 3, 4);
  const auto r = run_scrape(
      [&](double ms) {
        Scrape s = along_x(&wavy(), 0.1, ms);
        give_mode(s.sides[0], 400, 60);
        s.sides[0].roughness.height_m = 1e-6;
        if (static_cast<int>(ms) % 10 == 5) {
          if (where == 0) s.sides[0].place_m.x() = bad;
          if (where == 1) s.sides[0].velocity_m_s.y() = bad;
          if (where == 2) s.slide = static_cast<float>(bad);
          if (where == 3) s.sides[0].slide_vector.x() = static_cast<float>(bad);
          if (where == 4) s.cutoff_Hz = bad;
        }
        return s;
      },
      100, 100);
  for (const float x : r.sound) REQUIRE(std::abs(x) < 1);
}

TEST_CASE("Contacts beyond the maximum number leave the sounding ones unchanged") {
  auto scrapes = std::make_unique<Scrapes>(kRate);
  for (int i = 0; i < 3 * Scrapes::kMax; ++i) {
    Scrape s = along_x(&wavy(), 0.1, 0);
    s.id = i;
    scrapes->update(s);
  }
  CHECK(scrapes->active() == Scrapes::kMax);
  CHECK(scrapes->force(0) != nullptr);
}

TEST_CASE("A scrape with rare updates continues until its next update") {
  const ReliefLevels relief(make_relief(waves(), rough()));
  const auto scrape_at = [&](double ms) {
    Scrape s = along_x(&relief, 0.1, ms);
    s.update_interval_s = 0.088;
    return s;
  };
  const ScrapeRun r = run_scrape(scrape_at, 900, 900, 88);
  const double steady = rms(run_scrape(scrape_at, 900, 900).force, 0.4, 0.9);
  for (double t = 0.4; t < 0.86; t += 0.02) CHECK(rms(r.force, t, t + 0.02) > 0.5 * steady);
}
