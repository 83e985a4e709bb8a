// Tests of the tables of events and presentations: texts come from the bus.
#include "sync/log/export_events.h"

#include <catch2/catch.hpp>
#include <tactus/presentation_t.hpp>

using namespace tactus;
using namespace tactus::sync;

TEST_CASE("The name of a modality or of a process from the bus stays one cell and is no formula") {
  presentation_t p{};
  p.event_id = -5;
  CHECK(csv_row("audio", p).starts_with("audio,-5,whole,"));
  CHECK(csv_row("=HYPERLINK(1)", p).starts_with("'=HYPERLINK(1),-5,"));
  CHECK(csv_row("a,b\n", p).starts_with("\"a,b\n\",-5,"));
  frame_shown_t shown{};
  CHECK(csv_row("@SUM(1)", shown).starts_with("'@SUM(1),"));
}
