#include "audio_node/devices/dac_clock.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace tactus;
using audio::CallbackTime;
using audio::DacClock;

namespace {

// A card that plays at a constant rate, read by callbacks with random lateness.
struct SimulatedCard {
  double drift = 0;        // of the card against the host clock
  double pa_offset_s = 0;  // clock of PortAudio minus host clock
  double jitter_s = 6e-6;  // of the readings of PortAudio, rms as measured on the virtual card
  double start_s = 5000;
  double latency_s = 0.008;
  std::mt19937 random{7};
  std::int64_t frame = 0;

  double out_s() const { return start_s + static_cast<double>(frame) / 48000 / (1 + drift); }
  CallbackTime next(int frames, bool underflow = false) {
    std::normal_distribution<double> noise(0, jitter_s);
    std::exponential_distribution<double> late(1 / 30e-6);
    const double read_s = out_s() - latency_s + late(random);
    CallbackTime t;
    t.current_s = read_s + pa_offset_s;
    t.dac_s = out_s() + pa_offset_s + noise(random);
    t.now = sync::host_time(std::llround((read_s + 3e-6 + late(random)) * 1e9));
    t.underflow = underflow;
    frame += frames;
    return t;
  }
};

constexpr double kSample_s = 1.0 / 48000;

}  // namespace

TEST_CASE("The time of a sample is accurate to one sample for any clock of PortAudio") {
  for (const double offset : {0.0, 1.79e9, -752.0})
    for (const double drift : {0.0, 100e-6, -100e-6}) {
      SimulatedCard card;
      card.pa_offset_s = offset, card.drift = drift;
      DacClock clock(48000);
      double worst = 0;
      bool covered = true;
      for (int block = 0; block < 4000; ++block) {
        const double truth = card.out_s();
        const auto e = clock.block(128, card.next(128), 0.008);
        const double error = static_cast<double>(sync::to_ns(e.first_sample)) * 1e-9 - truth;
        if (block > 750) worst = std::max(worst, std::abs(error));  // 2 s
        covered &= block < 20 || std::abs(error) <= sync::to_seconds(e.uncertainty) + kSample_s / 2;
      }
      CAPTURE(offset, drift, worst);
      CHECK(worst < kSample_s);
      CHECK(covered);
    }
}

TEST_CASE("The DAC clock restarts at once after an underflow") {
  SimulatedCard card;
  DacClock clock(48000);
  for (int block = 0; block < 1000; ++block) clock.block(128, card.next(128), 0.008);
  card.start_s += 0.06;  // a stall
  const double truth = card.out_s();
  const auto e = clock.block(128, card.next(128, true), 0.008);
  // One reading and one calibration: its noise, and the lateness of that one callback (about 30 us, rarely 200).
  CHECK(std::abs(static_cast<double>(sync::to_ns(e.first_sample)) * 1e-9 - truth) < 300e-6);
}

TEST_CASE("The DAC clock ignores one bad reading and follows a lasting jump") {
  SimulatedCard card;
  DacClock clock(48000);
  for (int block = 0; block < 1000; ++block) clock.block(128, card.next(128), 0.008);
  CallbackTime bad = card.next(128);
  bad.dac_s += 0.004;
  clock.block(128, bad, 0.008);
  double truth = card.out_s();
  auto e = clock.block(128, card.next(128), 0.008);
  CHECK(std::abs(static_cast<double>(sync::to_ns(e.first_sample)) * 1e-9 - truth) < kSample_s);
  card.start_s += 0.01;
  for (int block = 0; block < 20; ++block) truth = card.out_s(), e = clock.block(128, card.next(128), 0.008);
  CHECK(std::abs(static_cast<double>(sync::to_ns(e.first_sample)) * 1e-9 - truth) < 2 * kSample_s);
}

TEST_CASE("Without times of PortAudio the reported latency is used and added to the uncertainty") {
  DacClock clock(48000);
  CallbackTime t;
  t.now = sync::host_time(5'000'000'000);
  const auto e = clock.block(128, t, 0.01);
  CHECK(e.first_sample == sync::host_time(5'010'000'000));
  CHECK(e.uncertainty >= sync::Nanoseconds(10'000'000));
}

TEST_CASE("The times of blocks are even when the callback is late at times") {
  SimulatedCard card;
  DacClock clock(48000);
  double before = 0, worst = 0;
  for (int block = 0; block < 4000; ++block) {
    CallbackTime t = card.next(128);
    // From time to time the thread is suspended for half a block between the reading of the card and ours.
    if (block % 50 == 49) t.now += sync::Nanoseconds(1'300'000);
    const double at = static_cast<double>(sync::to_ns(clock.block(128, t, 0.008).first_sample)) * 1e-9;
    if (block > 750) worst = std::max(worst, std::abs(at - before - 128 * kSample_s));
    before = at;
  }
  // Of the noise of each reading of about 10 us the loop passes on sqrt(2) 2 pi 0.5 Hz 2.7 ms = 1.2 %.
  CHECK(worst < 1e-6);
}

TEST_CASE("Stalls with underflows and a late first callback leave no lasting error") {
  SimulatedCard card;
  DacClock clock(48000);
  for (int block = 0; block < 1000; ++block) clock.block(128, card.next(128), 0.008);
  for (int stall = 0; stall < 5; ++stall) {
    card.start_s += 0.03;
    CallbackTime late = card.next(128, true);
    late.now += sync::Nanoseconds(700'000);  // after PortAudio had read its clock
    clock.block(128, late, 0.008);
    double truth = 0;
    DacClock::Estimate e;
    for (int block = 0; block < 750; ++block)
      truth = card.out_s(), e = clock.block(128, card.next(128), 0.008);  // 2 s
    CHECK(std::abs(static_cast<double>(sync::to_ns(e.first_sample)) * 1e-9 - truth) < kSample_s);
  }
  CHECK(clock.reseeds() == 6);
}

TEST_CASE("The time of a sample stays accurate when the clock of PortAudio steps") {
  const double step_s = GENERATE(-0.99, -0.5, -0.02, -0.004, 0.004, 0.5, 0.99, -3.0, 3.0);
  CAPTURE(step_s);
  SimulatedCard card;
  DacClock clock(48000);
  for (int block = 0; block < 1000; ++block) clock.block(128, card.next(128), 0.008);
  card.pa_offset_s += step_s;
  double worst = 0;
  bool covered = true;
  for (int block = 0; block < 4000; ++block) {
    const double truth = card.out_s();
    const auto e = clock.block(128, card.next(128), 0.008);
    const double error = static_cast<double>(sync::to_ns(e.first_sample)) * 1e-9 - truth;
    worst = std::max(worst, std::abs(error));
    covered &= std::abs(error) <= sync::to_seconds(e.uncertainty) + kSample_s / 2;
  }
  // One callback calibrates a step beyond a second, the earliest of eight a smaller one: 30 us each on average,
  // rarely 0.2 ms, of which the loop passes on a few per cent until the minimum is found again.
  CHECK(worst < 2 * kSample_s);
  CHECK(covered);
}
