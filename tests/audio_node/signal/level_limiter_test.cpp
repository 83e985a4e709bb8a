#include "audio_node/signal/level_limiter.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "audio_node/signal/limiter.h"
#include "audio_node/signal/sound_dose.h"
#include "tests/audio_node/support/bench.h"

using namespace tactus::audio;
using namespace tactus::audio::test;
using std::numbers::pi;

namespace {

constexpr LevelLimiterDef kDef{};  // 85 dBA with 100 dB at full scale
constexpr auto kSecond = static_cast<std::size_t>(kRate);
// The limit keeps 5 % of its budget, and the gain stops rising 5 % before the rest is used; ripple of its mean power.
constexpr double kBelow_dB = 0.8;
constexpr auto kSettled = static_cast<std::size_t>(LevelLimiter::kSettled_s * kRate);

// A tone of two equal channels, at full scale times `level`.
std::vector<float> tone(double frequency_Hz, double level, std::size_t frames) {
  std::vector<float> x;
  for (std::size_t n = 0; n < frames; ++n)
    x.insert(x.end(), 2,
             static_cast<float>(level * std::sin(2 * pi * frequency_Hz * static_cast<double>(n) / kRate)));
  return x;
}

std::vector<float> played(std::vector<float> x, LevelLimiter limiter) {
  // Blocks of an odd size.
  const int frames = static_cast<int>(x.size() / 2);
  for (int done = 0; done < frames; done += 77) limiter.process(x.data() + 2 * done, std::min(77, frames - done));
  return x;
}

// Loudest mean of a whole second from `from` on, dBA, of one channel; computed by direct summation.
double loudest_second_dBA(const std::vector<float>& x, std::size_t channel, std::size_t from) {
  AWeighting weighting(kRate);
  std::vector<double> sum{0};
  for (std::size_t i = channel; i < x.size(); i += 2) {
    const double y = weighting.next(static_cast<double>(x[i]));
    sum.push_back(sum.back() + y * y);
  }
  double most = 0;
  for (std::size_t n = from; n + kSecond < sum.size(); ++n) most = std::max(most, sum[n + kSecond] - sum[n]);
  return kDef.full_scale_dB + 10 * std::log10(2 * most / kRate);
}

// Largest change of the gain from one frame to the next, dB.
double steepest_dB(const std::vector<float>& in, const std::vector<float>& out) {
  double steepest = 0, before = 0;
  for (std::size_t i = 0; i < in.size(); i += 2) {
    if (std::abs(in[i]) < 0.01f) continue;
    const double gain = 20 * std::log10(static_cast<double>(out[i]) / static_cast<double>(in[i]));
    if (i > 0) steepest = std::max(steepest, std::abs(gain - before));
    before = gain;
  }
  return steepest;
}

}  // namespace

TEST_CASE("A full-scale tone never exceeds the limit and settles just below it at any frequency, without a click") {
  LevelLimiterDef ears = kDef;
  ears.ears = true;
  for (const double frequency_Hz : {200., 1000., 4000.}) {
    const auto in = tone(frequency_Hz, 0.9, 8 * kSecond), out = played(in, {ears, kRate, 2});
    const double level = loudest_second_dBA(out, 0, kSettled);
    CAPTURE(frequency_Hz, level);
    CHECK(loudest_second_dBA(out, 0, 0) <= kDef.limit_dB);
    CHECK(level > kDef.limit_dB - kBelow_dB);
    CHECK(loudest_second_dBA(in, 0, kSettled) > kDef.limit_dB + 3);
    // 0.05 dB a sample, and twice that in the omitted frames around a zero. The ramp of the peak limiter is as steep.
    CHECK(steepest_dB(in, out) < 0.102);
  }
}

TEST_CASE("Below the limit the level limiter changes no bit, also after an excess") {
  // 15 dB below full scale is at the limit.
  LevelLimiterDef ears = kDef;
  ears.ears = true;
  const auto quiet = tone(1000, 0.17, 4 * kSecond), louder = tone(1000, 0.19, 4 * kSecond);
  const bool same = played(quiet, {ears, kRate, 2}) == quiet, turned = played(louder, {ears, kRate, 2}) != louder;
  CHECK(same);
  CHECK(turned);
  auto both = tone(1000, 0.9, 2 * kSecond);
  const std::size_t loud = both.size();
  const auto rest = tone(1000, 0.01, 6 * kSecond);
  both.insert(both.end(), rest.begin(), rest.end());
  const auto out = played(both, {kDef, kRate, 2});
  CHECK(out[loud - 101] != both[loud - 101]);
  // 20 dB up at 10 dB a second, after the slow mean has decayed.
  CHECK(std::equal(out.end() - 4 * 96000, out.end(), both.end() - 4 * 96000));
}

TEST_CASE("A strike at -12 dBFS that rings for a second is unchanged by the level limiter") {
  auto strike = tone(1000, 0.25, 3 * kSecond);
  for (std::size_t i = 0; i < strike.size(); ++i)
    strike[i] *= static_cast<float>(std::exp(-6.9 * static_cast<double>(i / 2) / kRate));
  const bool same = played(strike, {kDef, kRate, 2}) == strike;
  CHECK(same);
}

TEST_CASE("The louder ear counts, and the powers of loudspeakers add up") {
  const auto settled = [](bool ears, bool both) {
    LevelLimiterDef def = kDef;
    def.ears = ears;
    auto x = tone(1000, 0.9, 6 * kSecond);
    for (std::size_t i = 1; !both && i < x.size(); i += 2) x[i] = 0;
    return loudest_second_dBA(played(x, {def, kRate, 2}), 0, kSettled);
  };
  for (const auto& [ears, both] : {std::pair(true, false), {true, true}, {false, false}, {false, true}}) {
    const double most = kDef.limit_dB - (!ears && both ? 10 * std::log10(2) : 0);
    CAPTURE(ears, both);
    CHECK(settled(ears, both) <= most);
    CHECK(settled(ears, both) > most - kBelow_dB);
  }
}

TEST_CASE("Samples that are not finite become silence, larger ones full scale, and the state recovers") {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e38f}) {
    LevelLimiter limiter(kDef, kRate, 2);
    std::vector<float> x(2 * 100, bad);
    limiter.process(x.data(), 100);
    bool bounded = true;
    for (const float y : x) bounded &= std::abs(y) <= 1;  // false for NaN
    CHECK(bounded);
    if (!(bad == 1e38f)) CHECK(std::all_of(x.begin(), x.end(), [](float y) { return y == 0; }));
    const auto after = tone(1000, 0.1, kSecond / 2);
    const bool same = played(after, limiter) == after;
    CHECK(same);
  }
}

TEST_CASE("The weekly dose is 80 dBA for 40 hours, and 3 dB more halve the time") {
  const auto exposure = [](double level_dB, std::size_t seconds) {
    LevelLimiter limiter(kDef, kRate, 1);
    // One channel, unchanged.
    std::vector<float> x;
    const double level = std::pow(10, (level_dB - kDef.full_scale_dB) / 20);
    for (std::size_t n = 0; n < seconds * kSecond; ++n)
      x.push_back(static_cast<float>(level * std::sin(2 * pi * 1000 * static_cast<double>(n) / kRate)));
    limiter.process(x.data(), static_cast<int>(x.size()));
    const double first = limiter.take_exposure_Pa2_s();
    CHECK(limiter.take_exposure_Pa2_s() == 0);
    return first;
  };
  // 0.04 Pa^2 is 80 dB. The onset of the filter takes 1e-3 of a second.
  CHECK(exposure(80, 4) == Approx(0.04 * 4).epsilon(1e-3));
  CHECK(exposure(83.0103, 2) == Approx(exposure(80, 4)).epsilon(1e-3));
  CHECK(sound_dose_days(0.04 * 40 * 3600, 80) == Approx(7));
  CHECK(sound_dose_days(0.04 * 40 * 3600, 75) == Approx(7 * std::pow(10, 0.5)));
  // Reduced sound counts as played.
  CHECK(exposure(100, 8) < 4 * exposure(85, 8));
}

TEST_CASE("The sound dose is reported in per cent of the daily allowance") {
  CHECK(dose_text(0).empty());
  CHECK(dose_text(0.001) == ", sound dose of this run below 1 % of a day's");
  CHECK(dose_text(0.034) == ", sound dose of this run 3 % of a day's");
  CHECK(dose_text(2.5) == ", sound dose of this run 250 % of a day's");
}

TEST_CASE("The sound of 128 bodies stays within the limit, and its exposure is measured") {
  auto bench = std::make_unique<Bench>();
  std::mt19937 random(5);
  for (int i = 0; i < 128; ++i)
    REQUIRE(bench->queues.strikes.push(
        strike_of(i, i, 300 + 20 * static_cast<double>(random() % 100), 0, bench->time_ns(500), 1)));
  while (bench->left.size() < 8 * kSecond) bench->play(128);
  std::vector<float> both;
  for (const float x : bench->left) both.insert(both.end(), 2, x);
  const double loud = loudest_second_dBA(both, 0, 0), level = loudest_second_dBA(both, 0, kSettled);
  CAPTURE(loud, level);
  CHECK(loud <= kDef.limit_dB);
  CHECK(level > kDef.limit_dB - 1);
  CHECK(bench->queues.exposure.gain.load() < 0.5);
  const double exposure = bench->queues.exposure.exposure_Pa2_s.load();
  CHECK(exposure > 7 * 0.1265 / 2);  // 85 dBA are 0.1265 Pa^2
  CHECK(exposure < 2 * 8 * 0.1265);
}

TEST_CASE("A series of strikes at -12 dBFS is unchanged by the level limiter") {
  const auto play = [](double limit_dB) {
    RendererDef def;
    def.level_limit.limit_dB = limit_dB;
    auto queues = std::make_unique<CallbackQueues>();
    auto renderer = std::make_unique<Renderer>(*queues, def);
    for (int i = 0; i < 12; ++i)
      queues->strikes.push(
          strike_of(i, i % 3, 400 + 100 * i, 12, kStart_ns + i * std::int64_t{250'000'000}, 0.25f));
    std::vector<float> out(2 * 128), all;
    for (int n = 0; n < 1200; ++n) {
      renderer->render(out.data(), 128,
                       {tactus::sync::host_time(kStart_ns + std::llround(n * 128e9 / kRate)), {}, {}});
      all.insert(all.end(), out.begin(), out.end());
    }
    return all;
  };
  const auto limited = play(85);
  CHECK(*std::max_element(limited.begin(), limited.end()) > 0.2f);
  const bool same = limited == play(120), other = limited != play(60);
  CHECK(same);
  CHECK(other);
}
