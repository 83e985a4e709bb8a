#include "audio_node/samples/recorded_contact_queue.h"

#include <catch2/catch.hpp>

using namespace tactus;
using namespace tactus::audio;

TEST_CASE("The end of a recorded contact waits for room, unless the contact goes on. Lost states are counted") {
  Spsc<RecordedContact> queue(4);
  RecordedContactQueue line(queue);
  const auto tell = [&](std::int64_t contact, std::int32_t part, bool ends) {
    RecordedContact r;
    r.contact = contact, r.part = part, r.ends = ends;
    return line.submit(r);
  };
  for (int i = 0; i < 4; ++i) REQUIRE(tell(1, 0, false));
  CHECK_FALSE(tell(1, 0, false));
  CHECK(line.lost() == 1);
  CHECK_FALSE(tell(1, 0, true));
  CHECK_FALSE(tell(1, 1, true));
  CHECK_FALSE(tell(1, 1, false));  // that part continues
  CHECK(line.lost() == 2);
  for (RecordedContact r; queue.pop(r);) CHECK_FALSE(r.ends);
  line.send_ends();
  line.send_ends();
  RecordedContact end;
  REQUIRE(queue.pop(end));
  CHECK(end.ends);
  CHECK(end.part == 0);
  CHECK_FALSE(queue.pop(end));
}
