// The A-weighting of sound level meters, sample by sample. Pure.
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace tactus::audio {

// IEC 61672-1:2013, annex E: four zeros at 0 Hz, poles at f1 twice, f2, f3 and f4 twice, gain 1 at 1 kHz. By the
// bilinear transform: the weight at f is that of the standard at (rate / pi) tan(pi f / rate), so at 48 kHz 0.5 dB
// less at 8 kHz and 2.5 dB less at 12.5 kHz, within class 1. Realtime-safe: yes.
class AWeighting {
 public:
  static constexpr std::size_t kStates = 6;
  using State = std::array<double, kStates>;

  explicit AWeighting(double rate_Hz) {
    for (std::size_t i = 0; i < kPoles_Hz.size(); ++i) {
      const double g = std::numbers::pi * kPoles_Hz[i] / rate_Hz;
      step_[i] = g / (1 + g);
    }
    gain_ = 1 / std::abs(response(1000, rate_Hz));
  }
  double next(double x) {
    for (std::size_t i = 0; i < kPoles_Hz.size(); ++i) {
      const double move = (x - state_[i]) * step_[i], low = state_[i] + move;
      state_[i] = low + move;
      x = i < kZeros ? x - low : low;
    }
    return gain_ * x;
  }
  const State& state() const { return state_; }
  void set_state(const State& state) { state_ = state; }

 private:
  static constexpr std::array<double, kStates> kPoles_Hz{20.598997, 20.598997, 107.65265,
                                                         737.86223, 12194.217, 12194.217};
  static constexpr std::size_t kZeros = 4;

  // Before the gain is known.
  static std::complex<double> response(double frequency_Hz, double rate_Hz) {
    const std::complex<double> s(0,
                                 rate_Hz / std::numbers::pi * std::tan(std::numbers::pi * frequency_Hz / rate_Hz));
    std::complex<double> h = 1;
    for (std::size_t i = 0; i < kPoles_Hz.size(); ++i) h *= (i < kZeros ? s : kPoles_Hz[i]) / (s + kPoles_Hz[i]);
    return h;
  }

  State step_{}, state_{};
  double gain_ = 1;
};

}  // namespace tactus::audio
