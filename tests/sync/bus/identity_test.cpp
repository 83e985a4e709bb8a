// Tests of incarnations, event ids and clock ids.
#include "sync/bus/identity.h"

#include <catch2/catch.hpp>
#include <set>

using namespace tactus::sync;

TEST_CASE("FNV-1a matches the published test vectors") {
  CHECK(fnv1a_32("") == 0x811c9dc5u);
  CHECK(fnv1a_32("a") == 0xe40c292cu);
  CHECK(fnv1a_32("foobar") == 0xbf9cf968u);
  CHECK(static_cast<std::uint64_t>(fnv1a_64("", 0)) == 0xcbf29ce484222325ull);
  CHECK(static_cast<std::uint64_t>(fnv1a_64("foobar", 6)) == 0x85944171f73967e8ull);
}

TEST_CASE("Every start is a new incarnation of the same source") {
  std::set<std::int64_t> incarnations;
  for (int i = 0; i < 100; ++i) {
    const Identity id = Identity::fresh("audio_node", 3);
    CHECK(id.incarnation > 0);
    CHECK(id.source == Identity::fresh("audio_node", 4).source);
    CHECK(id.run_id == 3);
    incarnations.insert(id.incarnation);
  }
  CHECK(incarnations.size() == 100);
}

TEST_CASE("Ids of two incarnations never collide and are never negative") {
  CHECK(prefixed_id(5, 1) != prefixed_id(6, 1));
  CHECK(prefixed_id(5, 1) != prefixed_id(5, 2));
  CHECK(prefixed_id(-1, -1) >= 0);
}

TEST_CASE("A clock id depends on the boot, the time namespace and the offset of that namespace") {
  const auto id = clock_id("a", 1, "monotonic 0 0");
  CHECK(id == clock_id("a", 1, "monotonic 0 0"));
  CHECK(id != clock_id("b", 1, "monotonic 0 0"));
  CHECK(id != clock_id("a", 2, "monotonic 0 0"));
  CHECK(id != clock_id("a", 1, "monotonic 5 0"));
  CHECK(clock_of_this_process() == clock_of_this_process());
  CHECK(Identity::fresh("audio_node", 1).clock == Identity::fresh("sim_node", 2).clock);
}
