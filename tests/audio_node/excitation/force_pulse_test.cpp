#include "audio_node/excitation/force_pulse.h"

#include <catch2/catch.hpp>

using namespace tactus::audio;

namespace {

double sum(const ForcePulse& pulse) {
  double all = 0;
  for (int i = -10; i < length_of(pulse) + 10; ++i) all += static_cast<double>(weight_at(pulse, i));
  return all;
}

}  // namespace

TEST_CASE("A force pulse of any length carries its whole impulse and is zero outside of its length") {
  for (const int n : {1, 2, 3, 17, 960}) {
    CAPTURE(n);
    CHECK(sum(one_hump(n)) == Approx(1).epsilon(1e-5));
    CHECK(length_of(one_hump(n)) == n);
    CHECK(weight_at(one_hump(n), -1) == 0);
    CHECK(weight_at(one_hump(n), n) == 0);
  }
  CHECK(length_of(ForcePulse{}) == 0);
  CHECK(weight_at(ForcePulse{}, 0) == 0);
}

TEST_CASE("Later humps of a pulse start at their times and share one impulse") {
  const ForcePulse pulse{Hump{0, 4, 0.7f}, {100, 8, 0.2f}, {50, 1, 0.1f}};
  CHECK(sum(pulse) == Approx(1).epsilon(1e-5));
  CHECK(length_of(pulse) == 108);
  CHECK(weight_at(pulse, 50) == Approx(0.1f));
  CHECK(weight_at(pulse, 20) == 0);
  CHECK(weight_at(pulse, 99) == 0);
  CHECK(weight_at(pulse, 104) > 0);
  SECTION("overlapping humps add up") {
    const ForcePulse both{Hump{0, 4, 0.5f}, {2, 4, 0.5f}};
    CHECK(sum(both) == Approx(1).epsilon(1e-5));
    CHECK(weight_at(both, 2) == Approx(weight_at({Hump{0, 4, 0.5f}}, 2) + weight_at({Hump{2, 4, 0.5f}}, 2)));
  }
}

TEST_CASE("A joined pulse acts in full from its own beginning") {
  const ForcePulse first{Hump{0, 40, 0.8f}, {60, 20, 0.2f}}, other{Hump{0, 30, 0.7f}, {35, 10, 0.3f}};
  ForcePulse both = first;
  REQUIRE(has_room(both, 20));
  join(both, 20, other, 22, 0.5f);
  CHECK(length_of(both) == 80);
  for (int i = 20; i < 90; ++i)
    CHECK(weight_at(both, i) == Approx(weight_at(first, i) + 0.5f * weight_at(other, i - 22)).margin(1e-7));
  SECTION("a joined pulse replaces ended humps, and is ignored without a free one") {
    join(both, 20, one_hump(50), 30, 1);
    REQUIRE_FALSE(has_room(both, 20));
    const ForcePulse full = both;
    join(both, 20, other, 25, 1);
    CHECK(sum(both) == sum(full));
    // At 41 only the first hump is over.
    REQUIRE(has_room(both, 41));
    join(both, 41, other, 45, 0.5f);
    for (int i = 41; i < 100; ++i)
      CHECK(weight_at(both, i) ==
            Approx(weight_at(full, i) + 0.5f * weight_at(one_hump(30), i - 45)).margin(1e-7));
  }
}
