// Renders a log by sound, picture and warmth, faster than real time: the libraries of the nodes on a manual clock. Touch is rendered while
// the world runs, because it acts on the world.
#pragma once

#include <map>
#include <span>
#include <tactus/contact_event_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/scene_t.hpp>
#include <vector>

#include "sync/time/time.h"

namespace tactus::bench {

struct ModalityResult {
  std::int64_t expected = 0, presented = 0;
  // Time of presentation, minus the instant of the event and the commanded delay; s, for each event.
  std::vector<double> error_s;
};

struct Rendered {
  std::vector<contact_event_t> events;  // events of the whole log, each once, in order of time
  ModalityResult audio, visual, thermal;
  // Onsets found in the samples, of isolated hits: time by event id, less the delay.
  std::map<std::int64_t, double> onset_s;  // simulated time at which its sound begins
  std::vector<float> samples;              // left, at 48 kHz, from kWorldBegins_ns on
};

Rendered render_log(const scene_t& scene, std::span<const std::uint8_t> log);

}  // namespace tactus::bench
