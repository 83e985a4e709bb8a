#include "sync/relay/newest_message.h"

#include <catch2/catch.hpp>

#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

using tactus::test::kMs;
constexpr std::int64_t kBegin_ns = 50'000'000'000;
HostTime at(int ms) { return host_time(kBegin_ns + kMs * ms); }
header_t numbered(std::int64_t seq, std::int64_t ms) {
  header_t h{};
  h.seq = seq, h.publish_time_ns = kBegin_ns + kMs * ms;
  return h;
}
NewestMessage of_20ms() { return NewestMessage(Nanoseconds(20 * kMs)); }

}  // namespace

TEST_CASE("A repeated and an overtaken message are old, also when they come late and in order") {
  auto newest = of_20ms();
  for (int i = 0; i < 10; ++i) CHECK_FALSE(newest.is_old(numbered(i, i), at(i)));
  CHECK(newest.is_old(numbered(9, 9), at(10)));
  // The messages 10 to 59 wait on their way, and 60 overtakes them.
  CHECK_FALSE(newest.is_old(numbered(60, 60), at(60)));
  for (int i = 10; i < 60; ++i) CHECK(newest.is_old(numbered(i, i), at(61)));
  CHECK_FALSE(newest.is_old(numbered(61, 61), at(62)));
  CHECK(newest.header().seq == 61);
}

TEST_CASE("A message whose number and time are ahead makes the true ones old for the patience at most") {
  for (const int ahead_ms : {1, 19, 50, 500, 999, 1001, 100'000}) {
    INFO(ahead_ms << " ms ahead");
    auto newest = of_20ms();
    for (int i = 0; i < 100; ++i) newest.is_old(numbered(i, i), at(i));
    CHECK_FALSE(newest.is_old(numbered(100'000, 100 + ahead_ms), at(100)));
    int old = 0;
    for (int i = 100; i < 2000; ++i) old += newest.is_old(numbered(i, i), at(i));
    CHECK(old <= 20);
    CHECK(newest.header().seq == 1999);
  }
}

TEST_CASE("Repetitions of a message do not make it the newest, for any time") {
  auto newest = of_20ms();
  for (int i = 0; i < 10; ++i) newest.is_old(numbered(i, i), at(i));
  for (int i = 10; i < 1000; ++i) {
    CHECK(newest.is_old(numbered(9, 9), at(i)));
    CHECK(newest.is_old(numbered(5, 5), at(i)));
  }
  CHECK(newest.header().seq == 9);
}

TEST_CASE("Messages of a sender that come twice, the second time late, are each passed once") {
  auto newest = of_20ms();
  int passed = 0;
  for (int i = 0; i < 1000; ++i) {
    passed += !newest.is_old(numbered(i, i), at(i));
    if (i >= 100) passed += !newest.is_old(numbered(i - 100, i - 100), at(i));
  }
  CHECK(passed == 1000);
}
