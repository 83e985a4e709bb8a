// A log rendered by sound, picture and warmth, faster than time: the libraries of the nodes on a clock that is
// moved by hand. Touch is rendered while the world runs, since it answers.
#pragma once

#include <map>
#include <span>
#include <tactus/contact_event_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/scene_t.hpp>
#include <vector>

#include "sync/time/time.h"

namespace tactus::bench {

struct SenseResult {
  std::int64_t owed = 0, presented = 0;
  // Presented, minus the instant of the event plus the delay that the sense was told to keep; s, of each.
  std::vector<double> error_s;
};

struct Rendered {
  std::vector<contact_event_t> events;  // of the whole log, each once, in order of time
  SenseResult audio, visual, thermal;
  // Onsets read out of the samples, of hits that are alone: event and host time, less the delay.
  std::map<std::int64_t, double> heard_s;  // simulated time at which its sound begins
  std::vector<float> samples;              // left, at 48 kHz, from kWorldBegins_ns on
};

Rendered render_log(const scene_t& scene, std::span<const std::uint8_t> log);

}  // namespace tactus::bench
