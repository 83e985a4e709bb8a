#include "audio_node/samples/loops.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "audio_node/modal/bank/ring.h"
#include "tests/audio_node/support/bench.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;
using std::numbers::pi;

namespace {

// Whole waves, so that it is seamless: multiples of 240 samples at 200 Hz.
Recording waves(double frequency_Hz, int samples = 24000) {
  Recording r;
  for (int n = 0; n < samples; ++n)
    r.samples.push_back(static_cast<float>(std::sin(2 * pi * frequency_Hz * n / kRate)));
  r.peak = 1, r.rms = 0.7071f;
  return r;
}

Layers layers(std::vector<std::pair<double, double>> speed_and_frequency) {
  Layers l;
  for (const auto& [speed, f] : speed_and_frequency) l.by_speed.push_back({speed, 1, {waves(f)}});
  return l;
}

sync::HostTime at(double samples) { return sync::host_time(kStart_ns + std::llround(samples * 1e9 / kRate)); }

// Updated once a block of kMaxBlock by `set_contact` (null: no update), left channel at 1 m.
struct LoopBench {
  Loops loops{kRate};
  std::vector<float> left;
  void play(int blocks, const std::function<void(RecordedContact&)>& set_contact) {
    for (int b = 0; b < blocks; ++b) {
      const sync::HostTime first = at(static_cast<double>(left.size()));
      if (set_contact) {
        RecordedContact r;
        r.contact = 4, r.database = 1, r.at = first, r.level = 0.1f;
        r.place.direction = Eigen::Vector3f::UnitY();
        set_contact(r);
        loops.update(r);
      }
      std::vector<float> mix(2 * kMaxBlock);
      loops.render(mix.data(), kMaxBlock, first);
      for (int n = 0; n < kMaxBlock; ++n) left.push_back(mix[static_cast<std::size_t>(2 * n)]);
    }
  }
  float most(std::size_t from, std::size_t to) const {
    float m = 0;
    for (std::size_t n = from; n < to; ++n) m = std::max(m, std::abs(left[n]));
    return m;
  }
  float steepest(std::size_t from = 1) const {
    float m = 0;
    for (std::size_t n = from; n < left.size(); ++n) m = std::max(m, std::abs(left[n] - left[n - 1]));
    return m;
  }
};

// Upward crossings of zero per second.
double frequency_Hz(const std::vector<float>& x, std::size_t from, std::size_t to) {
  int count = 0;
  std::size_t first = 0, last = 0;
  for (std::size_t n = from + 1; n < to; ++n)
    if (x[n - 1] < 0 && x[n] >= 0) {
      if (count++ == 0) first = n;
      last = n;
    }
  return (count - 1) * kRate / static_cast<double>(last - first);
}

constexpr int kSecond = 48000 / kMaxBlock;

}  // namespace

TEST_CASE("A loop plays over its seam for the duration of its contact, and is then silent") {
  const Layers l = layers({{1, 400}});
  LoopBench s;
  const auto set_contact = [&](RecordedContact& r) { r.layers = &l, r.speed_m_s = 1; };
  s.play(2 * kSecond, set_contact);
  CHECK(s.loops.active() == 1);
  CHECK(s.most(24000, 96000) == Approx(0.1).epsilon(1e-3));
  // A sine of that level, over four passes of the loop: no step is above its slope; at the beginning the slope of
  // the level is added (1/240 of it a sample).
  CHECK(s.steepest() <= 0.1 * (2 * pi * 400 / kRate + 1.0 / 240) * 1.001);
  const std::size_t ended = s.left.size();
  s.play(kSecond, nullptr);
  // 30 ms until it counts as over, then 5 ms times ln(1e5) to 1e-6, and a block.
  const auto over = ended + static_cast<std::size_t>((0.03 + 0.005 * std::log(1e5) + 0.003) * kRate);
  CHECK(s.most(over, s.left.size()) == 0);
  CHECK(s.loops.active() == 0);
  CHECK(s.steepest() <= 0.1 * (2 * pi * 400 / kRate + 1.0 / 240) * 1.001);
}

TEST_CASE("Twice the speed is an octave, which is the maximum shift of a loop") {
  const Layers l = layers({{1, 400}});
  for (const auto& [speed, ratio] :
       std::vector<std::pair<double, double>>{{1, 1}, {0.6, 0.6}, {2, 2}, {9, 2}, {0.01, 0.5}}) {
    LoopBench s;
    s.play(kSecond, [&, v = speed](RecordedContact& r) { r.layers = &l, r.speed_m_s = v; });
    CAPTURE(speed);
    // One sample in the whole second.
    CHECK(frequency_Hz(s.left, 4800, 48000) == Approx(400 * ratio).epsilon(2e-4));
  }
}

TEST_CASE("Layers crossfade without a click while the speed changes") {
  const Layers l = layers({{0.5, 300}, {2, 300}});
  LoopBench s;
  double v = 0.3;
  s.play(2 * kSecond, [&](RecordedContact& r) { r.layers = &l, r.speed_m_s = v *= 1.002; });
  // Two sines whose powers add up to that of one, at most an octave up, and the slope of the levels.
  CHECK(s.steepest() <= 0.1 * std::sqrt(2) * (2 * pi * 600 / kRate + 1.0 / 240) * 1.001);
  for (std::size_t n = 4800; n + 4800 < s.left.size(); n += 4800) CHECK(s.most(n, n + 4800) > 0.01);
}

TEST_CASE("Jumps of the level make no click") {
  const Layers l = layers({{1, 100}});
  LoopBench s;
  int i = 0;
  s.play(2 * kSecond, [&](RecordedContact& r) {
    r.layers = &l, r.speed_m_s = 1, r.level = (i / 50) % 2 ? 0.1f : 0.f;
    ++i;
  });
  CHECK(s.steepest() <= 0.1 * (2 * pi * 100 / kRate + 1.0 / 240) * 1.001);
  for (int k = 0; k < 20; ++k)
    CHECK(s.most(static_cast<std::size_t>(k) * 4800, static_cast<std::size_t>(k) * 4800 + 4800) <= 0.1001f);
}

TEST_CASE("A contact of another database is a new sound, and the previous one fades") {
  const Layers first = layers({{1, 400}}), second = layers({{1, 900}});
  LoopBench s;
  s.play(kSecond, [&](RecordedContact& r) { r.layers = &first, r.speed_m_s = 1; });
  s.play(kSecond, [&](RecordedContact& r) { r.layers = &second, r.speed_m_s = 1, r.database = 2; });
  CHECK(s.loops.active() == 1);
  CHECK(s.loops.oldest(7) == 2);
  CHECK(frequency_Hz(s.left, 60000, 96000) == Approx(900).epsilon(1e-3));
  CHECK(s.steepest() <= 0.2 * (2 * pi * 900 / kRate + 1.0 / 240) * 1.001);
}

TEST_CASE("Recorded contacts beyond the maximum number are silent") {
  const Layers l = layers({{1, 400}});
  Loops loops(kRate);
  for (std::int64_t id = 0; id < 100; ++id) {
    RecordedContact r;
    r.contact = id, r.database = 1, r.at = at(0), r.layers = &l, r.level = 0.01f, r.speed_m_s = 1;
    CHECK(loops.update(r) == (id < Loops::kMax));
  }
  CHECK(loops.active() == Loops::kMax);
}

TEST_CASE("A loop whose contact ends is silent 2 ms later, to the bit and without a click") {
  const Layers l = layers({{1, 400}});
  LoopBench s;
  const auto set_contact = [&](RecordedContact& r) { r.layers = &l, r.speed_m_s = 1; };
  s.play(kSecond, set_contact);
  const std::size_t ended = s.left.size();
  const auto end = [](RecordedContact& r) { r.ends = true; };
  s.play(2, end);  // a repeated end does not delay it
  s.play(kSecond / 10, nullptr);
  const auto over = ended + static_cast<std::size_t>(Loops::kEnd_s * kRate);
  CHECK(s.most(over - 48, over) > 0.01f);  // still audible halfway
  CHECK(s.most(over, s.left.size()) == 0);
  CHECK(s.loops.active() == 0);
  // The slope of the wave, and that of a level that falls from 0.1 within 96 samples.
  CHECK(s.steepest(ended) <= 0.1 * (2 * pi * 400 / kRate + 1.0 / 96) * 1.001);

  SECTION("a contact that resumes before its silence continues at its level") {
    LoopBench again;
    again.play(kSecond, set_contact);
    again.play(1, end);
    again.play(kSecond, set_contact);
    CHECK(again.steepest() <= 0.1 * (2 * pi * 400 / kRate + 1.0 / 96) * 1.001);
    CHECK(again.most(again.left.size() - 4800, again.left.size()) == Approx(0.1).epsilon(1e-3));
  }
}

TEST_CASE("A loop with rare updates continues until its next update") {
  const Layers l = layers({{1, 400}});
  LoopBench s;
  for (int i = 0; i < 10; ++i) {
    const auto set_contact = [&](RecordedContact& r) { r.layers = &l, r.speed_m_s = 1, r.update_interval_s = 0.088; };
    s.play(1, set_contact);
    s.play(65, nullptr);  // 88 ms in total
  }
  for (std::size_t n = 24000; n + 480 < s.left.size(); n += 480) CHECK(s.most(n, n + 480) > 0.09f);
}
