#include "visual_node/frame/quality_control.h"

#include <catch2/catch.hpp>

using namespace tactus;
using namespace tactus::visual;
using std::chrono::milliseconds;

TEST_CASE("Drawing beyond the time budget lowers the quality and is reported once") {
  QualityControl control{Settings{}};  // a step is left at 12.75 ms of 16.7 ms
  CHECK(control.take_change().empty());
  for (int i = 0; i < 100; ++i) control.add(milliseconds(10));
  CHECK(control.step() == 0);
  for (int i = 0; i < 100; ++i) control.add(milliseconds(control.step() == 0 ? 14 : 9));
  CHECK(control.step() == 1);
  CHECK(control.quality() == kQualities[1]);
  CHECK_THAT(control.take_change(), Catch::Contains("step 1 of 0..3") && Catch::Contains("too long"));
  CHECK(control.take_change().empty());
  for (int i = 0; i < 300; ++i) control.add(milliseconds(3));
  CHECK(control.step() == 0);
  CHECK_THAT(control.take_change(), Catch::Contains("step 0 of 0..3") && Catch::Contains("the whole picture"));
}

TEST_CASE("A fixed quality step does not depend on the drawing time") {
  Settings settings;
  settings.quality = std::string("2");
  QualityControl control(settings);
  CHECK_THAT(control.take_change(), Catch::Contains("as set"));
  for (int i = 0; i < 1000; ++i) control.add(milliseconds(i % 100));
  CHECK(control.step() == 2);
  CHECK(control.take_change().empty());
}
