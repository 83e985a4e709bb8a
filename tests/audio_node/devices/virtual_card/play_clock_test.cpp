#include "audio_node/devices/virtual_card/play_clock.h"

#include <catch2/catch.hpp>
#include <random>

using tactus::audio::PlayClock;

TEST_CASE("The position of the virtual card and its inverse agree to the nanosecond for days") {
  std::mt19937_64 random(8);
  for (const std::int64_t rate : {8000, 44100, 48000, 96000}) {
    const PlayClock clock{123'456'789, rate};
    CHECK(clock.position(0) == 0);
    for (int i = 0; i < 2000; ++i) {
      const auto frame = static_cast<std::int64_t>(random() % (std::uint64_t{86400} * 3 * 96000));
      const std::int64_t t = clock.time_of(frame);
      CHECK(clock.position(t) == frame);
      CHECK(clock.position(t - 1) == (frame == 0 ? 0 : frame - 1));
    }
  }
}
