// Tests of a display that another program drives: silent, repeated, misdated, two at the same time, restarted.
#include "thermal_node/devices/external.h"

#include <catch2/catch.hpp>
#include <cstring>

#include "tests/thermal_node/support/device_time.h"

using namespace tactus;
using namespace tactus::thermal;
using tactus::thermal::test::at;
using tactus::thermal::test::kClock;

namespace {

thermal_device_t reading(double degC, std::int64_t incarnation, std::int64_t seq, std::int64_t sent_ms) {
  thermal_device_t m = to_message({degC, 30}, 0);
  m.header.source = 9, m.header.run_id = 1, m.header.clock = kClock;
  m.header.incarnation = incarnation, m.header.seq = seq;
  m.header.publish_time_ns = sync::to_ns(at(sent_ms));
  return m;
}

// A display that has answered every 20 ms, the last time at 980 ms.
struct Answering {
  Answering() {
    for (int ms = 0; ms < 1000; ms += 20) device.receive(reading(30, 5, ++seq, ms), at(ms));
  }
  bool complains(sync::HostTime now, const char* part) const {
    const char* problem = device.problem(now);
    return problem && std::strstr(problem, part);
  }
  External device{0, kClock};
  int seq = 0;
};

}  // namespace

TEST_CASE("A display that has answered for a while has no problem") {
  Answering a;
  CHECK(a.device.problem(at(1000)) == nullptr);
  CHECK(a.device.step(30, 0, at(1000))->plate_degC == 30);
  CHECK(a.device.displays() == 1);
}

TEST_CASE("A display that has never answered, is silent, or has just begun is named") {
  External none(0, kClock);
  REQUIRE(none.problem(at(0)));
  CHECK_THAT(none.problem(at(0)), Catch::Contains("no display answers"));
  none.receive(reading(30, 5, 0, 0), at(0));
  CHECK_THAT(none.problem(at(10)), Catch::Contains("for a moment"));
  Answering a;
  CHECK(a.complains(at(1300), "silent"));
  CHECK_FALSE(a.device.step(30, 0, at(1300)));
}

TEST_CASE("A second display is a conflict, and its reading is not used") {
  Answering a;
  a.device.receive(reading(41, 6, 0, 1000), at(1000));
  CHECK(a.complains(at(1010), "two programs"));
  CHECK_FALSE(a.device.step(30, 0, at(1010)));
  for (int ms = 1000; ms < 2000; ms += 20) a.device.receive(reading(30, 5, ++a.seq, ms), at(ms));
  CHECK(a.device.problem(at(1990)) == nullptr);
  CHECK(a.device.step(30, 0, at(1990))->plate_degC == 30);
}

TEST_CASE("A restarted display is used within a second, and counts as another one") {
  Answering a;
  for (int ms = 1000; ms < 2000; ms += 20) {
    a.device.receive(reading(25, 6, ms, ms), at(ms));
    if (ms == 1900) CHECK(a.device.problem(at(ms)) == nullptr);
  }
  CHECK(a.device.displays() == 2);
  CHECK(a.device.step(30, 0, at(1990))->plate_degC == 25);
}

TEST_CASE("Repeated readings are silence") {
  Answering a;
  for (int ms = 1000; ms < 1300; ms += 20) a.device.receive(reading(30, 5, a.seq, 980), at(ms));
  CHECK(a.complains(at(1290), "silent"));
}

TEST_CASE("A reading that is dated ahead is not used, and does not hide later ones") {
  Answering a;
  a.device.receive(reading(41, 5, ++a.seq, 3'600'000), at(1000));
  CHECK(a.complains(at(1000), "dated ahead"));
  CHECK(a.device.step(30, 0, at(1000))->plate_degC == 30);
  for (int ms = 1020; ms < 2000; ms += 20) a.device.receive(reading(28, 5, ++a.seq, ms), at(ms));
  CHECK(a.device.problem(at(1990)) == nullptr);
  CHECK(a.device.step(30, 0, at(1990))->plate_degC == 28);
}
