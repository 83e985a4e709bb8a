// A contact that slides or rolls over a surface, updated at any rate, and its effect on a body with one mode.
#pragma once

#include <cmath>
#include <complex>
#include <functional>
#include <vector>

#include "audio_node/mixer/scrapes.h"
#include "tests/audio_node/support/bench.h"
#include "tests/audio_node/support/waves.h"

namespace tactus::audio::test {

inline constexpr float kForce = 0.01f;  // N s a sample and unit of slope

// Along x, to the left of the listener, at 1 m.
inline Scrape along_x(const ReliefLevels* relief, double speed_m_s, double ms) {
  Scrape s;
  s.id = 3, s.at = at_ms(ms), s.slide = kForce;
  s.place.direction = Eigen::Vector3f::UnitY();
  ScrapeSide& side = s.sides[0];
  side.known = true;
  side.relief = relief;
  side.place_m.x() = 1e-3 * ms * speed_m_s, side.velocity_m_s.x() = speed_m_s;
  side.slide_vector.x() = side.roll_vector.x() = 1;
  return s;
}

inline void give_mode(ScrapeSide& side, double frequency_Hz, double damping_1_s, float gain = 1) {
  const ModeStep step = mode_step(frequency_Hz, damping_1_s, kRate);
  side.voice = 7;
  side.resonators.add(step);
  side.gains[0] = gain * step.unit_gain;
}

struct ScrapeRun {
  std::vector<float> force, sound;
};

// Updated by `scrape_at` every `every_ms` for updated_ms; then it ends, and the rest is the decay.
inline ScrapeRun run_scrape(const std::function<Scrape(double ms)>& scrape_at, int updated_ms, int whole_ms, int every_ms = 1) {
  auto scrapes = std::make_unique<Scrapes>(kRate);
  auto voices = std::make_unique<Voices>(4, kRate, kRing);
  ScrapeRun out;
  for (int ms = 0; ms < whole_ms; ++ms) {
    if (ms < updated_ms && ms % every_ms == 0) scrapes->update(scrape_at(ms));
    if (ms == updated_ms) {
      Scrape end;
      end.id = 3, end.at = at_ms(ms), end.ends = true;
      scrapes->update(end);
    }
    float stereo[2 * 48] = {};
    const bool on = scrapes->active() > 0;
    scrapes->render(0, 48, at_ms(ms));
    scrapes->drive(*voices, 48);
    voices->render(stereo, 48);
    const float* force = on ? scrapes->force(3) : nullptr;
    for (int n = 0; n < 48; ++n) {
      out.force.push_back(force ? force[n] : 0);
      out.sound.push_back(stereo[2 * n]);
    }
  }
  return out;
}

// Amplitude of a tone, between two times.
inline double amplitude(const std::vector<float>& x, double frequency_Hz, double from_s, double to_s) {
  std::complex<double> sum = 0;
  double weight = 0;
  const auto from = static_cast<std::size_t>(from_s * kRate), to = static_cast<std::size_t>(to_s * kRate);
  for (std::size_t n = from; n < to; ++n) {
    const double window = 1 - std::cos(2 * M_PI * static_cast<double>(n - from) / static_cast<double>(to - from));
    sum += window * static_cast<double>(x[n]) *
           std::polar(1.0, -2 * M_PI * frequency_Hz * static_cast<double>(n) / kRate);
    weight += window;
  }
  return 2 * std::abs(sum) / weight;
}

inline double rms(const std::vector<float>& x, double from_s, double to_s) {
  double sum = 0;
  const auto from = static_cast<std::size_t>(from_s * kRate), to = static_cast<std::size_t>(to_s * kRate);
  for (std::size_t n = from; n < to; ++n) sum += static_cast<double>(x[n]) * static_cast<double>(x[n]);
  return std::sqrt(sum / static_cast<double>(to - from));
}

}  // namespace tactus::audio::test
