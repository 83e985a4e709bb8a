#include "audio_node/samples/shots.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numbers>
#include <tactus/presentation_t.hpp>

#include "tests/audio_node/support/bench.h"
#include "tests/audio_node/support/sounds.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

Recording recording(std::vector<float> x) {
  Recording r{std::move(x), 0, 0};
  for (const float s : r.samples) r.peak = std::max(r.peak, std::abs(s));
  return r;
}

// All of it to the left, at 1 m.
RecordedStrike shot(const Recording& r, float gain = 1, float step = 1) {
  RecordedStrike s;
  s.database = 1;
  s.shots[0] = {&r, gain, step};
  s.place.direction = Eigen::Vector3f::UnitY();
  return s;
}

std::vector<float> left_of(Shots& shots, int blocks) {
  std::vector<float> left;
  for (int b = 0; b < blocks; ++b) {
    std::vector<float> mix(2 * kMaxBlock);
    shots.render(mix.data(), kMaxBlock);
    for (int n = 0; n < kMaxBlock; ++n) left.push_back(mix[static_cast<std::size_t>(2 * n)]);
  }
  return left;
}

// Centre of the power spectrum by a plain Fourier transform, Hz.
double centroid_Hz(const std::vector<float>& x) {
  constexpr std::size_t kPoints = 2048;
  double sum = 0, weighted = 0;
  for (std::size_t k = 1; k < kPoints / 2; ++k) {
    double re = 0, im = 0;
    for (std::size_t n = 0; n < kPoints; ++n) {
      const double w = 2 * std::numbers::pi * static_cast<double>(k * n % kPoints) / kPoints;
      re += static_cast<double>(x[n]) * std::cos(w), im += static_cast<double>(x[n]) * std::sin(w);
    }
    const double power = re * re + im * im;
    sum += power, weighted += power * static_cast<double>(k) * kRate / kPoints;
  }
  return weighted / sum;
}

}  // namespace

TEST_CASE("At its own pitch a recording is played to the sample from the given frame on") {
  const Recording r = recording(tone(700, 0.05, 0.5));
  for (const int offset : {0, 1, 37, kMaxBlock - 1}) {
    Shots shots(kRate);
    shots.start(shot(r), 1, offset);
    const auto left = left_of(shots, 60);
    for (std::size_t n = 0; n < left.size(); ++n) {
      const auto k = static_cast<std::ptrdiff_t>(n) - offset;
      const bool inside = k >= 0 && k < static_cast<std::ptrdiff_t>(r.samples.size());
      REQUIRE(left[n] == Approx(inside ? r.samples[static_cast<std::size_t>(k)] : 0.f).margin(1e-7));
    }
    CHECK(shots.active() == 0);
  }
}

TEST_CASE("The centroid of the spectrum moves with the pitch") {
  const Recording r = recording(tone(1000, 0.5, 0.5, 48000, 60));
  double whole = 0;
  for (const float step : {1.f, 0.5f, 0.75f, 1.5f, 2.f}) {
    Shots shots(kRate);
    shots.start(shot(r, 1, step), 1, 0);
    const double centre = centroid_Hz(left_of(shots, 2048 / kMaxBlock));
    if (step == 1) whole = centre;
    CAPTURE(step, centre, whole);
    // The decay widens the line to 60 step / 2 pi Hz, and its parts at the far ends weigh slightly more; the
    // images of the cubic at 20 kHz are below -60 dB for 2 kHz.
    CHECK(centre / whole == Approx(static_cast<double>(step)).epsilon(0.02));
  }
}

TEST_CASE("A strike with a recording starts on the sample nearest to its time") {
  const Recording r = recording(tone(700, 0.05, 0.5));
  for (const std::int64_t after_ns : {5'000'000, 5'004'000, 7'777'777, 12'345'678}) {
    auto bench = std::make_unique<Bench>();
    Strike s;
    s.event_id = 9;
    s.scheduled = sync::host_time(kStart_ns + after_ns);
    s.recorded = shot(r);
    REQUIRE(bench->queues.strikes.push(s));
    while (bench->left.size() < 2000) bench->play(100);
    const auto first = std::find_if(bench->left.begin(), bench->left.end(), [](float x) { return x != 0; });
    const auto onset = static_cast<std::size_t>(first - bench->left.begin());
    // Half a sample, and 1 ns of rounding.
    CHECK(std::abs(bench->time_ns(onset) - kStart_ns - after_ns) <= static_cast<std::int64_t>(0.5e9 / kRate) + 2);
    REQUIRE(bench->reports.size() == 1);
    CHECK(bench->reports[0].outcome == presentation_t::PRESENTED);
    CHECK(std::abs(bench->reports[0].presented_ns - bench->time_ns(onset)) <= 2);
    CHECK(bench->queues.costs[0].contacts == 0);
    CHECK(bench->queues.costs[1].contacts == 1);
  }
}

TEST_CASE("When all voices of recordings are in use the quietest fades without a click") {
  const Recording r = recording(tone(200, 2, 0.5));
  Shots shots(kRate);
  for (int i = 0; i < Shots::kMax; ++i) shots.start(shot(r, i == 20 ? 1e-3f : 1e-2f), 1, 0);
  left_of(shots, 1);
  CHECK(shots.active() == Shots::kMax);
  shots.start(shot(r, 1e-2f), 1, 0);
  const auto left = left_of(shots, 10);
  CHECK(shots.active() == Shots::kMax);
  // All except the weak one continue: 63 in step, and one that begins. No step of a cosine 0.5 cos(w n) is above
  // 0.5 w, and the new one begins with its first sample.
  const double w = 2 * std::numbers::pi * 200 / kRate;
  for (std::size_t n = 1; n < left.size(); ++n)
    REQUIRE(std::abs(left[n] - left[n - 1]) <= (63 * 1e-2 + 1e-3 + 1e-2) * 0.5 * w + 1e-3 * 0.5 / 240 + 1e-6);
  // Beyond the number that may fade at a time one ends at once; never more than there is room for.
  for (int i = 0; i < 1000; ++i) shots.start(shot(r), 1, 0);
  left_of(shots, 1);
  CHECK(shots.active() <= Shots::kMax + 16);
  left_of(shots, 10);
  CHECK(shots.active() == Shots::kMax);
}

TEST_CASE("A recording of one sample ends at once, and one of zero strength is not played") {
  const Recording one = recording({0.5f});
  Shots shots(kRate);
  shots.start(shot(one), 1, 3);
  shots.start(shot(one, 0), 1, 3);
  const auto left = left_of(shots, 1);
  CHECK(left[3] == 0.5f);
  CHECK(shots.active() == 0);
}
