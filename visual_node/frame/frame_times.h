// Times of the stages of a frame, which split the latency from motion to pixel. Pure.
#pragma once

#include <string>
#include <tactus/media_clock_t.hpp>
#include <vector>

#include "sync/time/time.h"

namespace tactus::visual {

struct FrameTimes {
  sync::HostTime begun{};    // its poses were read
  sync::HostTime latched{};  // its surfaces were drawn and its events read
  sync::HostTime read{};     // its pixels lay in memory
};

// fence: the pair of the video, for the time of presentation. Returns the same index on the clocks of three more
// media, named after the video: VIDEO#begun, VIDEO#latched and VIDEO#read.
inline std::vector<media_clock_t> stages_of(const media_clock_t& fence, const FrameTimes& times) {
  std::vector<media_clock_t> pairs(3, fence);
  const auto set = [&](std::size_t i, const char* stage, sync::HostTime t) {
    pairs[i].medium += std::string("#") + stage;
    pairs[i].host_time_ns = sync::to_ns(t);
  };
  set(0, "begun", times.begun), set(1, "latched", times.latched), set(2, "read", times.read);
  return pairs;
}

}  // namespace tactus::visual
