#include "audio_node/modal/bank/ring.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

using namespace tactus::audio;
using std::numbers::pi;

namespace {

constexpr double kRate_Hz = 48000;

// A bank of modes with their exact trajectories, in double precision.
struct Bank {
  struct Mode {
    double frequency_Hz, damping_1_s;
  };
  std::vector<Mode> modes;
  int padded;
  std::unique_ptr<float[]> memory;
  Ringing ringing;
  float* gains;

  explicit Bank(std::vector<Mode> all) : modes(std::move(all)) {
    padded = (static_cast<int>(modes.size()) + kModeGroup - 1) / kModeGroup * kModeGroup;
    const auto n = static_cast<std::size_t>(padded);
    memory = std::make_unique<float[]>(5 * n + 16);
    void* at = memory.get();
    std::size_t space = (5 * n + 16) * sizeof(float);
    auto* a = static_cast<float*>(std::align(64, 5 * n * sizeof(float), at, space));
    REQUIRE(a);
    for (std::size_t i = 0; i < modes.size(); ++i) {
      const ModeStep s = mode_step(modes[i].frequency_Hz, modes[i].damping_1_s, kRate_Hz);
      a[i] = s.damping, a[n + i] = s.stiffness, a[4 * n + i] = s.unit_gain;
    }
    ringing = {a, a + n, a + 2 * n, a + 3 * n, padded};
    gains = a + 4 * n;
  }

  // Sample n after a unit impulse at sample 0, as documented in the header.
  double truth(std::size_t i, int n) const {
    const double w = 2 * pi * modes[i].frequency_Hz, d = modes[i].damping_1_s, t = (n + 0.5) / kRate_Hz;
    return std::exp(-d * t) * (std::cos(w * t) - d / w * std::sin(w * t));
  }

  std::vector<float> play(Ring ring, int frames, const std::vector<std::vector<float>>& forces, int block = 64) {
    std::vector<float> out(static_cast<std::size_t>(frames));
    for (int at = 0; at < frames; at += block) {
      std::vector<Push> pushes;
      for (const auto& f : forces) pushes.push_back({gains, f.data() + at});
      ring(ringing, pushes.data(), static_cast<int>(pushes.size()), std::min(block, frames - at), out.data() + at);
    }
    return out;
  }
  double amplitude() const {
    double most = 0;
    for (int i = 0; i < padded; ++i) most = std::max<double>(most, std::abs(ringing.velocity[i]));
    return most;
  }
};

std::vector<float> impulse(int frames, int at = 0, float size = 1) {
  std::vector<float> f(static_cast<std::size_t>(frames));
  f[static_cast<std::size_t>(at)] = size;
  return f;
}

std::vector<Bank::Mode> random_modes(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> octaves(std::log(40), std::log(16000)),
      damping(std::log(0.5), std::log(500));
  std::vector<Bank::Mode> modes;
  for (int i = 0; i < count; ++i) modes.push_back({std::exp(octaves(random)), std::exp(damping(random))});
  return modes;
}

}  // namespace

TEST_CASE("A mode rings at its frequency and decays with its damping from 40 Hz to 16 kHz, with any instructions") {
  for (const Instructions use : available_instructions())
    for (const double f : {40.0, 55.5, 440.0, 3000.0, 16000.0})
      for (const double d : {0.5, 10.0, 200.0}) {
        INFO(name(use) << " " << f << " Hz " << d << " / s");
        Bank bank({{f, d}});
        const int frames = 9600;
        const auto out = bank.play(ring(use), frames, {impulse(frames)});
        double worst = 0;
        for (int n = 0; n < frames; ++n)
          worst =
              std::max(worst, std::abs(static_cast<double>(out[static_cast<std::size_t>(n)]) - bank.truth(0, n)));
        // A frequency error of 0.01 % would give 2 pi f t 1e-4 after 0.2 s: 0.005 at 40 Hz and 2 at 16 kHz.
        // Single-precision steps have an error of 6e-8 each, as in a random walk, times 1 / w at low frequencies.
        CHECK(worst < 0.002);
      }
}

TEST_CASE("The modes of a body add up for any number, block length and instructions") {
  for (const Instructions use : available_instructions())
    for (const int count : {1, 15, 16, 17, 32, 48, 63, 100})
      for (const int block : {1, 7, 64}) {
        Bank bank(random_modes(count, static_cast<unsigned>(count)));
        const int frames = 200;
        const auto out = bank.play(ring(use), frames, {impulse(frames, 3)}, block);
        // The mean velocity of a sample is that of its middle, except for a phase of d w T^2 / 12.
        double phases = 0;
        for (const Bank::Mode& m : bank.modes)
          phases += m.damping_1_s * 2 * pi * m.frequency_Hz / (kRate_Hz * kRate_Hz) / 12;
        for (int n = 0; n < frames; ++n) {
          double sum = 0;
          for (std::size_t i = 0; n >= 3 && i < bank.modes.size(); ++i) sum += bank.truth(i, n - 3);
          REQUIRE(out[static_cast<std::size_t>(n)] == Approx(sum).margin(phases + 2e-4 * count));
        }
      }
}

TEST_CASE("Pushes at several places add up, and a later push leaves the ringing unchanged") {
  for (const Instructions use : available_instructions()) {
    const auto modes = random_modes(37, 5);
    const int frames = 500;
    const auto first = impulse(frames, 0), second = impulse(frames, 201, -0.5f),
               third = impulse(frames, 90, 0.25f);
    const auto a = Bank(modes).play(ring(use), frames, {first});
    const auto b = Bank(modes).play(ring(use), frames, {second});
    const auto c = Bank(modes).play(ring(use), frames, {third});
    const auto all = Bank(modes).play(ring(use), frames, {first, second, third});
    for (std::size_t n = 0; n < all.size(); ++n) REQUIRE(all[n] == Approx(a[n] + b[n] + c[n]).margin(1e-3));
  }
}

TEST_CASE("The same instructions give the same bits, and others nearly the same") {
  const int frames = 4800;
  const auto modes = random_modes(100, 9);
  const auto plain = Bank(modes).play(ring(Instructions::kSse2), frames, {impulse(frames)});
  for (const Instructions use : available_instructions()) {
    const auto once = Bank(modes).play(ring(use), frames, {impulse(frames)});
    CHECK(once == Bank(modes).play(ring(use), frames, {impulse(frames)}));
    for (std::size_t n = 0; n < once.size(); ++n) REQUIRE(once[n] == Approx(plain[n]).margin(0.05));
  }
}

TEST_CASE("A mode without a push never grows") {
  for (const Instructions use : available_instructions()) {
    Bank bank({{40, 0}, {1000, 0}, {16000, 0}});
    const int frames = 48000;
    bank.play(ring(use), frames, {impulse(frames)});
    CHECK(bank.amplitude() < 1.01);
  }
}

TEST_CASE("Instructions are selected by name, and unavailable ones are rejected") {
  const auto all = available_instructions();
  CHECK(find_instructions("auto") == all.back());
  CHECK(find_instructions("sse2") == Instructions::kSse2);
  CHECK_FALSE(find_instructions("mmx"));
  CHECK_FALSE(find_instructions(""));
  for (const Instructions i : {Instructions::kAvx2, Instructions::kAvx512})
    CHECK(find_instructions(name(i)).has_value() == (std::find(all.begin(), all.end(), i) != all.end()));
}
