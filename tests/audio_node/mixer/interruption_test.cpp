// Interruptions, stops of any length, and voices whose state is not a number: the sound goes to silence and
// returns through a fade.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "audio_node/mixer/recording_player.h"
#include "tests/audio_node/support/bench.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

constexpr int kFrames = 128;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// A renderer whose card can stand still.
struct PlayedCard {
  CallbackQueues queues;
  Renderer renderer{queues, {}};
  std::int64_t now_ns = kStart_ns;
  std::vector<float> left;

  void play(int blocks, bool interrupted = false) {
    for (int i = 0; i < blocks; ++i) {
      std::vector<float> out(2 * kFrames);
      renderer.render(out.data(), kFrames, {sync::host_time(now_ns), {}, {}, interrupted && i == 0});
      for (std::size_t n = 0; n < kFrames; ++n) left.push_back(out[2 * n]);
      now_ns += std::llround(kFrames * 1e9 / kRate);
    }
  }
  // Rings for seconds.
  void strike(std::int64_t id) {
    REQUIRE(queues.strikes.push(strike_of(id, id, 200, 0.5, now_ns + 5'000'000, 0.4f)));
  }
  float loudest(std::size_t from) const {
    float most = 0;
    for (std::size_t n = from; n < left.size(); ++n) most = std::max(most, std::abs(left[n]));
    return most;
  }
  float steepest(std::size_t from) const {
    float most = 0;
    for (std::size_t n = from; n < left.size(); ++n)
      most = std::max(most, std::abs(left[n] - (n > from ? left[n - 1] : 0)));
    return most;
  }
};

}  // namespace

TEST_CASE("After an underflow the sound returns from silence without a step") {
  auto card = std::make_unique<PlayedCard>();
  card->strike(1);
  card->play(40);
  const float usual = card->steepest(20 * kFrames);
  const std::size_t gap = card->left.size();
  card->now_ns += 3'000'000;
  card->play(40, true);
  CHECK(card->loudest(gap) > 0.1f);  // it still rings
  // Within the fade its own slope and that of the fade add up.
  CHECK(card->steepest(gap) < usual + 0.4f * 1.5708f / 240);
}

TEST_CASE("After a stop of any length nothing of before sounds, and new hits do") {
  std::mt19937_64 random(6);
  for (int trial = 0; trial < 50; ++trial) {
    auto card = std::make_unique<PlayedCard>();
    card->strike(1);
    card->play(20 + static_cast<int>(random() % 50));
    // 0.1 s to three years; some clocks step back.
    const auto stop_ns =
        static_cast<std::int64_t>(std::pow(10, 8.01 + static_cast<double>(random() % 900) * 1e-2));
    const std::size_t gap = card->left.size();
    card->now_ns += trial % 10 ? stop_ns : -stop_ns / 1'000'000'000 - 200'000'000;
    card->play(40, random() % 2 == 0);
    CAPTURE(trial, stop_ns);
    CHECK(card->loudest(gap) == 0);
    card->strike(2);
    card->play(40);
    CHECK(card->loudest(gap) > 0.1f);
    CHECK(std::all_of(card->left.begin(), card->left.end(), [](float x) { return std::abs(x) <= 0.9f; }));
  }
}

TEST_CASE("A voice whose state is not a number falls silent without a step, and others continue") {
  const auto play = [](bool fails, bool other) {
    Voices voices(4, kRate, kRing);
    std::vector<float> left;
    const Strike first = strike_of(1, 1, 200, 1, 0, 0.4f), second = strike_of(2, 2, 300, 1, 0, 0.4f);
    voices.strike(first.sides[0], 1, first.pulse, 0);
    if (other) voices.strike(second.sides[0], 1, second.pulse, 0);
    for (int block = 0; block < 100; ++block) {
      if (fails && block == 50) {
        StrikeSide bad = first.sides[0];
        bad.impulse = kNan;
        voices.strike(bad, 1, first.pulse, 10);
      }
      std::vector<float> mix(2 * kMaxBlock);
      voices.render(mix.data(), kMaxBlock);
      for (std::size_t n = 0; n < kMaxBlock; ++n) left.push_back(mix[2 * n]);
    }
    return left;
  };
  const auto sound = play(true, false), both = play(true, true), healthy = play(false, true),
             one = play(false, false);
  float usual = 0, step = 0, difference = 0;
  for (std::size_t n = 10 * kMaxBlock + 1; n < sound.size(); ++n) {
    CHECK(std::isfinite(sound[n]));
    usual = std::max(usual, std::abs(one[n] - one[n - 1]));
    step = std::max(step, std::abs(sound[n] - sound[n - 1]));
    // Only the first voice is missing from both.
    difference = std::max(difference, std::abs((healthy[n] - both[n]) - (one[n] - sound[n])));
  }
  CHECK(step < usual + 0.4f / kMaxBlock);
  CHECK(difference < 1e-5f);
  CHECK(std::all_of(sound.end() - 40 * kMaxBlock, sound.end(), [](float x) { return x == 0; }));
}

TEST_CASE("Recorded sounds whose strength, speed or pitch is not a number do not play") {
  Recording r;
  for (int i = 0; i < 4800; ++i) r.samples.push_back(0.3f * std::sin(0.05f * static_cast<float>(i)));
  r.peak = 0.3f, r.rms = 0.2f;
  Layers layers;
  layers.by_speed = {{0.1, 1, {r}}};
  constexpr float kInf = std::numeric_limits<float>::infinity();
  for (const float bad : {kNan, kInf, -kInf}) {
    Loops loops(kRate);
    Shots shots(kRate);
    for (int part = 0; part < 3; ++part) {
      RecordedContact contact;
      contact.contact = contact.part = part, contact.database = 1, contact.layers = &layers;
      contact.speed_m_s = part == 0 ? static_cast<double>(bad) : 0.1;
      contact.level = part == 1 ? bad : 0.1f;
      if (part == 2) contact.update_interval_s = static_cast<double>(bad);
      CHECK_FALSE(loops.update(contact));
    }
    for (int part = 0; part < 2; ++part) {
      RecordedStrike strike;
      strike.database = 1;
      strike.shots[0] = {&layers.by_speed[0].takes[0], part == 0 ? bad : 0.1f, part == 1 ? bad : 1.f};
      shots.start(strike, 1, 0);
    }
    CHECK(loops.active() + shots.active() == 0);
  }
}

TEST_CASE("A renderer that replaces another within a second keeps the level limit across both") {
  const auto loud = [](double spent_Pa2_s) {
    LevelLimiterDef def{.full_scale_dB = 100, .limit_dB = 85, .ears = true, .spent_Pa2_s = spent_Pa2_s};
    LevelLimiter limiter(def, kRate, 1);
    double sum_Pa2_s = 0;
    for (int n = 0; n < 24000; ++n) {
      float x = 0.9f * std::sin(0.13f * static_cast<float>(n));
      limiter.process(&x, 1);
    }
    sum_Pa2_s = limiter.take_exposure_Pa2_s();
    return std::pair(sum_Pa2_s, limiter.spent_Pa2_s());
  };
  const auto [first_Pa2_s, spent_Pa2_s] = loud(0);
  const auto [second_Pa2_s, again_Pa2_s] = loud(spent_Pa2_s);
  constexpr double kLimit_Pa2_s = 4e-10 * 316227766.;  // 85 dB for a second
  CHECK(first_Pa2_s + second_Pa2_s <= kLimit_Pa2_s);
  CHECK(second_Pa2_s > 0.4 * kLimit_Pa2_s / 2);  // the floor remains
  CHECK(again_Pa2_s < 0.6 * kLimit_Pa2_s);
}
