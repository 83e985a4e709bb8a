// Position of a sound card that plays at a constant rate. Pure.
#pragma once

#include <cstdint>

namespace tactus::audio {

// Frame 0 is out at start_ns; all times CLOCK_MONOTONIC, ns. Integer arithmetic: exact for days.
struct PlayClock {
  std::int64_t start_ns = 0;
  std::int64_t rate_Hz = 48000;

  // Number of frames whose time has come, >= 0.
  std::int64_t position(std::int64_t now_ns) const {
    if (now_ns < start_ns) return 0;
    const std::int64_t seconds = (now_ns - start_ns) / kSecond, rest = (now_ns - start_ns) % kSecond;
    return seconds * rate_Hz + rest * rate_Hz / kSecond;
  }
  // First ns at which position() reaches that frame.
  std::int64_t time_of(std::int64_t frame) const {
    return start_ns + frame / rate_Hz * kSecond + (frame % rate_Hz * kSecond + rate_Hz - 1) / rate_Hz;
  }
  static constexpr std::int64_t kSecond = 1'000'000'000;
};

}  // namespace tactus::audio
