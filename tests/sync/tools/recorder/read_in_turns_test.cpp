#include "sync/tools/recorder/read_in_turns.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>

using tactus::sync::read_in_turns;

namespace {

struct FakePort {
  int waiting = 0;    // messages in its buffer
  int refill = 0;     // messages that arrive during each read
  int total_read = 0;

  int read(int batch) {
    const int count = std::min(batch, waiting);
    waiting += refill - count;
    total_read += count;
    return count;
  }
};

int read_both(std::array<FakePort, 2>& ports, int max_messages) {
  return read_in_turns(ports, 64, max_messages, [](FakePort& port, int batch) { return port.read(batch); });
}

}  // namespace

TEST_CASE("All pending messages of both ports are read") {
  std::array<FakePort, 2> ports{FakePort{1000}, FakePort{130}};
  CHECK(read_both(ports, 50'000) == 1130);
  CHECK(ports[0].waiting == 0);
  CHECK(ports[1].waiting == 0);
}

TEST_CASE("Reading ends under a flood that refills a port faster than it is read") {
  std::array<FakePort, 2> ports{FakePort{1000, 200}, FakePort{10}};
  const int count = read_both(ports, 5000);
  CHECK(count >= 5000);
  CHECK(count < 5000 + 2 * 64);
  CHECK(ports[1].total_read == 10);  // a flood of one port does not hide the other
}
