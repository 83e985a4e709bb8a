#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <random>
#include <tactus/presentation_t.hpp>
#include <vector>

#include "tests/audio_node/support/bench.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;
using std::numbers::pi;

namespace {

std::size_t first_sound(const std::vector<float>& x, std::size_t from = 0) {
  while (from < x.size() && x[from] == 0) ++from;
  return from;
}

}  // namespace

TEST_CASE("Sound starts on the sample nearest to its time, for any time and any block sizes") {
  std::mt19937 random(4);
  for (int trial = 0; trial < 200; ++trial) {
    auto bench = std::make_unique<Bench>();
    const std::int64_t at = kStart_ns + 5'000'000 + static_cast<std::int64_t>(random() % 40'000'000);
    REQUIRE(bench->queues.strikes.push(strike_of(7, 1, 500, 20, at)));
    while (bench->left.size() < 3000) bench->play(1 + static_cast<int>(random() % 300));
    const std::size_t onset = first_sound(bench->left);
    CAPTURE(trial, at, onset);
    // Half a sample either way, and 1 ns of rounding.
    CHECK(std::abs(bench->time_ns(onset) - at) <= static_cast<std::int64_t>(0.5e9 / kRate) + 2);
    REQUIRE(bench->reports.size() == 1);
    CHECK(bench->reports[0].event_id == 7);
    CHECK(bench->reports[0].outcome == presentation_t::PRESENTED);
    CHECK(std::abs(bench->reports[0].presented_ns - bench->time_ns(onset)) <= 2);
    CHECK(bench->reports[0].uncertainty_ns >= 5000);
  }
}

TEST_CASE("A late strike is played at once, a very late strike is dropped, and both are reported") {
  auto bench = std::make_unique<Bench>();
  bench->play(480);
  REQUIRE(bench->queues.strikes.push(strike_of(1, 1, 500, 20, bench->time_ns(480) - 10'000'000)));
  REQUIRE(bench->queues.strikes.push(strike_of(2, 2, 500, 20, bench->time_ns(480) - 40'000'000)));
  bench->play(480);
  REQUIRE(bench->reports.size() == 2);
  CHECK(bench->reports[0].outcome == presentation_t::DROPPED_LATE);
  CHECK(bench->reports[0].presented_ns == -1);
  CHECK(bench->reports[1].outcome == presentation_t::LATE);
  // The earliest sample that can still be changed, after the delay of the limiter.
  CHECK(first_sound(bench->left) == 480 + Limiter::kDelay);
  CHECK(std::abs(bench->reports[1].presented_ns - bench->time_ns(480 + Limiter::kDelay)) <= 2);
}

TEST_CASE("A strike is on time within the slack, then weaker with its lateness, then dropped") {
  // Without damping, so that the level after the onset is the strength.
  const auto played = [](double late_s) {
    auto bench = std::make_unique<Bench>();
    bench->play(480);
    const double first = 480 + Limiter::kDelay;  // the earliest sample that can still be changed
    const auto at = kStart_ns + std::llround((first / kRate - late_s) * 1e9);
    REQUIRE(bench->queues.strikes.push(strike_of(1, 1, 500, 0, at)));
    for (int i = 0; i < 4; ++i) bench->play(480);
    REQUIRE(bench->reports.size() == 1);
    const double level = *std::max_element(bench->left.begin(), bench->left.end());
    return std::pair(bench->reports[0].outcome, level);
  };
  const auto [in_time, full] = played(0);
  REQUIRE(in_time == presentation_t::PRESENTED);
  CHECK(full == Approx(0.1).epsilon(1e-3));
  CHECK(played(2.4 / kRate) == std::pair(in_time, full));
  for (const double late_s : {2.7 / kRate, 0.001, 0.01, 0.02, 0.0299}) {
    const auto [outcome, level] = played(late_s);
    CHECK(outcome == presentation_t::LATE);
    // Linear from the slack of 2.5 samples to the limit of 30 ms.
    const double slack_s = 2.5 / kRate;
    CHECK(level == Approx(full * (0.03 - late_s) / (0.03 - slack_s)).margin(1e-3 * full));
  }
  const auto [beyond, nothing] = played(0.0301);
  CHECK(beyond == presentation_t::DROPPED_LATE);
  CHECK(nothing == 0);
}

TEST_CASE("A strike that its lateness makes too weak is reported as inaudible") {
  auto bench = std::make_unique<Bench>();
  bench->play(480);
  Strike s = strike_of(1, 1, 500, 20, bench->time_ns(480) - 20'000'000);
  s.min_audible_gain = 0.5f;
  REQUIRE(bench->queues.strikes.push(s));
  bench->play(480);
  REQUIRE(bench->reports.size() == 1);
  CHECK(bench->reports[0].outcome == presentation_t::INAUDIBLE);
  CHECK(bench->reports[0].presented_ns > 0);
}

TEST_CASE("A struck voice rings at its frequency and decays at its rate") {
  auto bench = std::make_unique<Bench>();
  const double f = 440, d = 12;
  REQUIRE(bench->queues.strikes.push(strike_of(1, 1, f, d, bench->time_ns(1000))));
  while (bench->left.size() < 30000) bench->play(128);
  // A mass on a spring and a damper, struck: its velocity is exp(-d t) (cos w t - d/w sin w t), here in the middle
  // of each sample from 1000 on. Single-precision poles have an error of 6e-8 a sample: 2e-3 over 29000 of them.
  double worst = 0;
  for (std::size_t n = 1000; n < 30000; ++n) {
    const double t = (static_cast<double>(n - 1000) + 0.5) / kRate, w = 2 * pi * f;
    const double v = 0.1 * std::exp(-d * t) * (std::cos(w * t) - d / w * std::sin(w * t));
    worst = std::max(worst, std::abs(static_cast<double>(bench->left[n]) - v));
  }
  CHECK(worst < 0.1 * 2e-3);
}

TEST_CASE("A strike on a sounding voice adds to it and keeps its state") {
  const auto play = [](std::vector<std::size_t> strikes) {
    auto bench = std::make_unique<Bench>();
    for (const std::size_t s : strikes) bench->queues.strikes.push(strike_of(1, 1, 300, 5, bench->time_ns(s)));
    while (bench->left.size() < 9000) bench->play(100);
    return bench->left;
  };
  const auto first = play({500}), second = play({3000}), both = play({500, 3000});
  for (std::size_t n = 0; n < 9000; ++n) CHECK(both[n] == Approx(first[n] + second[n]).margin(1e-5));
}

TEST_CASE("The energy of a struck voice decays to silence, and the voice becomes free") {
  Voices voices(4, kRate, kRing);
  const Strike s = strike_of(1, 1, 700, 60, 0);
  voices.strike(s.sides[0], 1, one_hump(20), 3);
  std::vector<float> mix(2 * kMaxBlock);
  const auto render = [&] {
    std::fill(mix.begin(), mix.end(), 0.f);
    voices.render(mix.data(), kMaxBlock);
  };
  render();
  double before = voices.energy();
  REQUIRE(before > 0);
  for (int block = 0; block < 300 && voices.active(); ++block) {
    render();
    CHECK(voices.energy() < before);
    // |z|^2 falls by exp(-2 d t) over a block.
    if (voices.active())
      CHECK(voices.energy() == Approx(before * std::exp(-2 * 60 * kMaxBlock / kRate)).epsilon(1e-4));
    before = voices.energy();
  }
  CHECK(voices.active() == 0);
}

TEST_CASE("A force pulse of any length carries its impulse and leaves modes above its spectrum at rest") {
  // At low frequency only the impulse counts; above the first zero of its spectrum, 2 / T, little remains.
  for (const int length : {1, 2, 10, 48, 200}) {
    Voices voices(2, kRate, kRing);
    const Strike low = strike_of(1, 1, 20, 0, 0, 1), high = strike_of(2, 2, 5000, 0, 0, 1);
    voices.strike(low.sides[0], 1, one_hump(length), 0);
    std::vector<float> mix(2 * kMaxBlock);
    for (int block = 0; block < 5; ++block) voices.render(mix.data(), kMaxBlock);
    CHECK(std::sqrt(voices.energy()) == Approx(1).epsilon(0.02));  // 1 - (pi f T)^2 / 6 with T < 4.2 ms
    Voices other(2, kRate, kRing);
    other.strike(high.sides[0], 1, one_hump(length), 0);
    for (int block = 0; block < 5; ++block) other.render(mix.data(), kMaxBlock);
    if (length >= 48) CHECK(std::sqrt(other.energy()) < 0.02);
  }
}

TEST_CASE("The same strikes in the same blocks give the same samples to the bit") {
  const auto play = [] {
    auto bench = std::make_unique<Bench>();
    std::mt19937 random(5);
    for (int i = 0; i < 300; ++i) {
      Strike s = strike_of(i, static_cast<std::int64_t>(random() % 90), 100 + random() % 9000, 1 + random() % 90,
                           bench->time_ns(random() % 40000), 0.3f);
      s.pulse = one_hump(1 + static_cast<int>(random() % 60));
      bench->queues.strikes.push(s);
    }
    while (bench->left.size() < 48000) bench->play(1 + static_cast<int>(random() % 256));
    return bench->left;
  };
  const auto a = play(), b = play();
  REQUIRE(a.size() == b.size());
  CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

TEST_CASE("Waiting strikes are reported as dropped when the stream is closed") {
  auto bench = std::make_unique<Bench>();
  bench->queues.strikes.push(strike_of(1, 1, 300, 5, bench->time_ns(90000)));
  bench->play(64);
  bench->queues.strikes.push(strike_of(2, 1, 300, 5, bench->time_ns(90000)));
  bench->renderer.abandon();
  bench->play(0);
  REQUIRE(bench->reports.size() == 2);
  for (const presentation_t& r : bench->reports) CHECK(r.outcome == presentation_t::DROPPED_LATE);
}

TEST_CASE("A report that does not fit is counted") {
  auto bench = std::make_unique<Bench>();
  while (bench->queues.reports.push({})) continue;
  REQUIRE(bench->queues.strikes.push(strike_of(1, 1, 500, 20, kStart_ns + 1'000'000)));
  std::vector<float> block(2 * 480);
  bench->renderer.render(block.data(), 480, {sync::host_time(kStart_ns), {}, {}});
  CHECK(bench->queues.reports_lost == 1);
}

TEST_CASE("A callback longer than half a block is divided into blocks of at least half of the maximum") {
  for (int frames = 1; frames <= 4096; ++frames) {
    CAPTURE(frames);
    int left = frames, least = kMaxBlock, most = 0;
    while (left > 0) {
      const int block = next_block(left);
      REQUIRE(block > 0);
      least = std::min(least, block), most = std::max(most, block);
      left -= block;
    }
    REQUIRE(left == 0);
    REQUIRE(most <= kMaxBlock);
    REQUIRE(least >= std::min(frames, kMaxBlock / 2));
  }
}

TEST_CASE("A callback of any length has no block that is too short for a crossfade") {
  const int frames = GENERATE(33, 63, 65, 67, 129, 191, 193, 257, 1000, 1025, 2049, 4095);
  CAPTURE(frames);
  const double f = 440, w = 2 * pi * f / kRate;
  auto bench = std::make_unique<Bench>();
  REQUIRE(bench->queues.strikes.push(strike_of(1, 1, f, 0, kStart_ns + 5'000'000)));
  while (bench->left.size() < 2000) bench->play(frames);
  const std::size_t from = bench->left.size();
  const double gain = *std::max_element(bench->left.begin(), bench->left.end());
  // Blows without strength on the last sample of each callback, from the right and the left in alternation.
  for (std::int64_t i = 0; i < 8; ++i) {
    const std::size_t last = bench->left.size() + static_cast<std::size_t>(frames + Limiter::kDelay) - 1;
    Strike turned = strike_of(2 + i, 1, f, 0, bench->time_ns(last), 0);
    if (i % 2 == 0) turned.sides[0].place.direction = -Eigen::Vector3f::UnitY();
    REQUIRE(bench->queues.strikes.push(turned));
    bench->play(frames);
  }
  bench->play(frames);
  double bend = 0;
  for (std::size_t n = from; n + 1 < bench->left.size(); ++n) {
    const auto at = [&](std::size_t k) { return static_cast<double>(bench->left[k]); };
    bend = std::max(bend, std::abs(at(n + 1) - 2 * at(n) + at(n - 1)));
  }
  // At worst the crossfade takes 32 samples: a corner of 1/32, and twice that times the slope of the tone.
  CHECK(bend < (w * w + 1.0 / 32 + 2 * w / 32) * gain);
}
