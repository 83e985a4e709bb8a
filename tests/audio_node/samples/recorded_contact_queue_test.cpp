#include "audio_node/samples/recorded_contact_queue.h"

#include <catch2/catch.hpp>

using namespace tactus;
using namespace tactus::audio;

TEST_CASE("An end of a recorded contact that does not fit is sent later unless its contact continues") {
  Spsc<RecordedContact> ring(4);
  RecordedContactQueue queue(ring);
  const auto submit = [&](std::int64_t contact, std::int32_t part, bool ends) {
    RecordedContact r;
    r.contact = contact, r.part = part, r.ends = ends;
    return queue.submit(r);
  };
  for (int i = 0; i < 4; ++i) REQUIRE(submit(1, 0, false));
  CHECK_FALSE(submit(1, 0, false));
  CHECK(queue.lost() == 1);
  CHECK_FALSE(submit(1, 0, true));
  CHECK_FALSE(submit(1, 1, true));
  CHECK_FALSE(submit(1, 1, false));  // that part continues
  CHECK(queue.lost() == 2);
  for (RecordedContact r; ring.pop(r);) CHECK_FALSE(r.ends);
  queue.send_ends();
  queue.send_ends();
  RecordedContact end;
  REQUIRE(ring.pop(end));
  CHECK(end.ends);
  CHECK(end.part == 0);
  CHECK_FALSE(ring.pop(end));
}
