// A renderer with a manual clock, and strikes of a body with one mode.
#pragma once

#include <cmath>
#include <deque>
#include <memory>
#include <tactus/presentation_t.hpp>
#include <vector>

#include "audio_node/mixer/renderer.h"

namespace tactus::audio::test {

inline constexpr double kRate = 48000;
// Available on every machine.
inline const Ring kRing = ring(Instructions::kSse2);
inline constexpr std::int64_t kStart_ns = 1'000'000'000'000;

// Of the modes of a body, for as long as the test runs.
inline const Resonators* kept(const Resonators& resonators) {
  static std::deque<Resonators> all;
  return &all.emplace_back(resonators);
}

inline Strike strike_of(std::int64_t id, std::int64_t voice, double frequency_Hz, double damping_1_s,
                        std::int64_t at_ns, float impulse = 0.1f) {
  Strike s;
  s.event_id = id;
  s.scheduled = sync::host_time(at_ns);
  StrikeSide& side = s.sides[0];
  side.voice = voice;
  const ModeStep step = mode_step(frequency_Hz, damping_1_s, kRate);
  Resonators resonators;
  resonators.add(step);
  side.resonators = kept(resonators);
  side.gains[0] = step.unit_gain;
  side.impulse = impulse;
  side.place.direction = Eigen::Vector3f::UnitY();  // all of it to the left
  return s;
}

struct Bench {
  CallbackQueues queues;
  sync::Nanoseconds used{0};  // reported rendering time of each block
  Renderer renderer{queues, {}};
  std::vector<float> left;
  std::vector<presentation_t> reports;

  std::int64_t time_ns(std::size_t sample) const {
    return kStart_ns + std::llround(static_cast<double>(sample) * 1e9 / kRate);
  }
  void play(int frames) {
    std::vector<float> block(2 * static_cast<std::size_t>(frames));
    renderer.render(block.data(), frames, {sync::host_time(time_ns(left.size())), sync::Nanoseconds(5000), used});
    for (int n = 0; n < frames; ++n) left.push_back(block[2 * static_cast<std::size_t>(n)]);
    for (presentation_t r; queues.reports.pop(r);) reports.push_back(r);
  }
};

}  // namespace tactus::audio::test
