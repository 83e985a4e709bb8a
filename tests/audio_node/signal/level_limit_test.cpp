// The level limit, for any input and setting, against an independent computation of the level.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "audio_node/signal/level_limiter.h"
#include "tests/audio_node/support/level_oracle.h"

using namespace tactus::audio;
using namespace tactus::audio::test;
using std::numbers::pi;

namespace {

// Samples are floats: their rounding changes a sum of squares by less than 2^-23.
constexpr double kRounding_dB = 1e-5;

struct Setup {
  LevelLimiterDef def;
  double rate_Hz = 48000;
  int channels = 2;
};

std::vector<float> limited(std::vector<float> x, const Setup& s) {
  LevelLimiter limiter(s.def, s.rate_Hz, s.channels);
  const int frames = static_cast<int>(x.size()) / s.channels;
  for (int done = 0; done < frames; done += 77)
    limiter.process(x.data() + s.channels * done, std::min(77, frames - done));
  return x;
}

double loudest_dBA(const std::vector<float>& x, const Setup& s) {
  return loudest_second_by_oracle_dBA(x, s.channels, s.rate_Hz, s.def.full_scale_dB, s.def.ears);
}

// The same sound in all channels.
template <class Sound>
std::vector<float> in_all_channels(const Setup& s, double seconds, Sound sound) {
  std::vector<float> x;
  for (std::int64_t n = 0; n < std::llround(seconds * s.rate_Hz); ++n)
    x.insert(x.end(), static_cast<std::size_t>(s.channels),
             static_cast<float>(sound(static_cast<double>(n) / s.rate_Hz)));
  return x;
}

// A sound of 2.5 s that tries to exceed the limit.
std::vector<float> any_sound(const Setup& s, std::mt19937& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double f = 20 * std::pow(0.45 * s.rate_Hz / 20, uniform(0, 1)), level = std::pow(10, uniform(-3, 0));
  const double period_s = std::pow(10, uniform(-2.5, 0.3)), duty = uniform(0.02, 0.9),
               decay_1_s = std::pow(10, uniform(-1, 2.5));
  const auto kind = random() % 10;
  float held = 0;
  return in_all_channels(s, 2.5, [&](double t) -> double {
    const double tone = std::sin(2 * pi * f * t), phase = std::fmod(t, period_s) / period_s;
    switch (kind) {
      case 0: return tone;                                            // from the first sample on
      case 1: return t < 1.2 ? level * tone : tone;                   // a step in level
      case 2: return phase < duty ? tone : 0;                         // bursts that begin and end at once
      case 3: return tone * std::exp(-decay_1_s * phase * period_s);  // blows
      case 4: return phase < duty ? 1 : -1;                           // square waves, as low as 0.5 Hz
      case 5: return uniform(-1, 1);                                  // noise
      case 6: return random() % 2 ? 1 : -1;                           // the loudest noise
      case 7: return phase < 0.5 / s.rate_Hz / period_s ? 1 : 0;      // clicks
      case 8: return tone > 0 ? level : -1;                           // with a constant part
      default:                                                        // random levels that last for a while
        if (random() % 500 == 0) held = static_cast<float>(uniform(-1, 1));
        return static_cast<double>(held);
    }
  });
}

}  // namespace

TEST_CASE("The independent computation of the level gives 100 dBA for a full-scale tone of 1 kHz") {
  const Setup s{{100, 85, true}, 48000, 2};
  const auto x = in_all_channels(s, 3, [](double t) { return std::sin(2 * pi * 1000 * t); });
  CHECK(loudest_dBA(x, s) == Approx(100).margin(0.01));
  Setup loudspeakers = s;
  loudspeakers.def.ears = false;
  CHECK(loudest_dBA(x, loudspeakers) == Approx(103.01).margin(0.01));
}

TEST_CASE("No second is louder than the limit: tones, bursts, blows, steps and noise with the default settings") {
  std::mt19937 random(11);
  for (int trial = 0; trial < 60; ++trial) {
    const Setup s{{100, 85, trial % 2 == 0}, 48000, trial % 3 ? 2 : 1};
    const auto in = any_sound(s, random), out = limited(in, s);
    CAPTURE(trial, loudest_dBA(in, s));
    CHECK(loudest_dBA(out, s) <= s.def.limit_dB + kRounding_dB);
  }
}

TEST_CASE("No second is louder than the limit, for any setting in its range") {
  std::mt19937 random(12);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double rates_Hz[] = {8000, 11025, 22050, 44100, 48000};
  for (int trial = 0; trial < 150; ++trial) {
    const Setup s{{uniform(70, 130), uniform(40, 100), random() % 2 == 0},
                  rates_Hz[random() % 5],
                  1 + static_cast<int>(random() % 3)};
    const auto in = any_sound(s, random), out = limited(in, s);
    CAPTURE(trial, s.def.full_scale_dB, s.def.limit_dB, s.rate_Hz, s.channels, s.def.ears, loudest_dBA(in, s));
    CHECK(loudest_dBA(out, s) <= s.def.limit_dB + kRounding_dB);
    CHECK(std::all_of(out.begin(), out.end(), [](float y) { return std::abs(y) <= 1; }));  // false for NaN
  }
}

TEST_CASE("The limit holds for samples with random bits, and the gain recovers") {
  std::mt19937 random(13);
  const Setup s{{110, 80, true}, 48000, 2};
  std::vector<float> x(2 * 48000);
  for (float& v : x) {
    const auto bits = static_cast<std::uint32_t>(random());
    std::memcpy(&v, &bits, sizeof v);
  }
  const auto quiet = in_all_channels(s, 6, [](double t) { return 0.003 * std::sin(2 * pi * 500 * t); });
  x.insert(x.end(), quiet.begin(), quiet.end());
  const auto out = limited(x, s);
  CHECK(loudest_dBA(out, s) <= s.def.limit_dB + kRounding_dB);
  CHECK(std::equal(out.end() - 48000, out.end(), x.end() - 48000));
}

TEST_CASE("Sound that is cut at any moment stays within the limit") {
  const Setup s{{120, 60, true}, 48000, 1};
  std::mt19937 random(14);
  for (int trial = 0; trial < 40; ++trial) {
    const double f = 20 * std::pow(500, (trial + 0.5) / 40),
                 cut_s = 0.5 + static_cast<double>(random() % 1000) * 1e-3;
    auto x = in_all_channels(s, 2, [&](double t) { return t < cut_s ? std::sin(2 * pi * f * t) : 0; });
    CAPTURE(f, cut_s);
    CHECK(loudest_dBA(limited(x, s), s) <= s.def.limit_dB + kRounding_dB);
  }
}

TEST_CASE("The gain of the level limit changes by at most 0.06 dB a sample up to 14 dB above the allowed level") {
  const Setup s{{100, 85, true}, 48000, 1};
  for (const double level : {0.25, 0.4, 0.9}) {
    LevelLimiter limiter(s.def, s.rate_Hz, 1);
    double before = 1, steepest_dB = 0;
    for (int n = 0; n < 3 * 48000; ++n) {
      float x = static_cast<float>(level * std::sin(2 * pi * 700 * n / s.rate_Hz));
      limiter.process(&x, 1);
      steepest_dB = std::max(steepest_dB, std::abs(20 * std::log10(limiter.gain() / before)));
      before = limiter.gain();
    }
    CAPTURE(level);
    CHECK(steepest_dB > 0);
    CHECK(steepest_dB < 0.06);
  }
}
