// Renders strikes into samples: the pure heart of the audio callback, usable without a sound card.
#pragma once

#include <tactus/presentation_t.hpp>

#include "audio_node/limiter.h"
#include "audio_node/scheduler.h"
#include "audio_node/spsc.h"
#include "audio_node/voices.h"

namespace tactus::audio {

// When the first sample of a block is physically out, and how surely that is known.
struct BlockTime {
  sync::HostTime first_sample{};
  sync::Nanoseconds uncertainty{0};
};

// The two queues between the node's loop and the callback.
struct Crossing {
  Spsc<Strike> strikes{512};
  Spsc<presentation_t> reports{4096};
};

// Same strikes, same blocks, same times: the same samples to the bit.
class Renderer {
 public:
  Renderer(Crossing& crossing, double rate_Hz, double ceiling, sync::Nanoseconds late_limit);

  // Fills `frames` stereo frames and reports what became of each strike. A strike that is due before what can
  // still be changed is played at once and called late, or dropped when it is later than the limit. Realtime-safe:
  // yes.
  void render(float* stereo, int frames, const BlockTime& time);

  // What waits will never sound: reports all of it as dropped. Of the loop's thread, once the callback has ended.
  void abandon();

  int sounding() const { return voices_.active(); }

 private:
  void render_some(float* stereo, int frames, const BlockTime& time);
  void begin(const Strike& strike, int frames, const BlockTime& time);
  void report(const Strike& strike, std::int8_t outcome, std::int64_t presented_ns, sync::Nanoseconds uncertainty);
  sync::Nanoseconds samples(int count) const;

  Crossing& crossing_;
  double rate_Hz_;
  sync::Nanoseconds late_limit_;
  Scheduler scheduler_{512};
  Voices voices_{64};
  Limiter limiter_;
};

}  // namespace tactus::audio
