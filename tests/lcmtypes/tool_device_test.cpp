#include "lcmtypes/tool_device.h"

#include <catch2/catch.hpp>

using namespace tactus;
using Catch::Contains;

TEST_CASE("The device of a tool is parsed whole, without a look at its file") {
  CHECK(parse_tool_device("virtual_hand").kind == ToolDevice::Kind::kVirtualHand);
  CHECK(parse_tool_device("virtual_hand").file.empty());
  CHECK(parse_tool_device("virtual_hand:a b.csv").file == "a b.csv");
  const ToolDevice device = parse_tool_device("playback:no/such.csv,scale=0.5,offset=1/-2/0.5,rate=2");
  CHECK(device.kind == ToolDevice::Kind::kPlayback);
  CHECK(device.file == "no/such.csv");
  CHECK(device.placement.scale == 0.5);
  CHECK(device.placement.offset_m == Eigen::Vector3d(1, -2, 0.5));
  CHECK(device.placement.rate == 2);
}

TEST_CASE("What is wrong with the device of a tool is said in one sentence") {
  for (const char* unknown : {"", "phantom", "evil:x.csv", "playback2:x.csv", "VIRTUAL_HAND"})
    CHECK_THROWS_WITH(parse_tool_device(unknown), Contains("unknown") && Contains("use virtual_hand"));
  CHECK_THROWS_WITH(parse_tool_device("playback"), Contains("name the file"));
  CHECK_THROWS_WITH(parse_tool_device("playback:"), Contains("name a file"));
  CHECK_THROWS_WITH(parse_tool_device("playback:,rate=1"), Contains("name a file"));
  CHECK_THROWS_WITH(parse_tool_device("playback:x.csv,speed=1"), Contains("\"speed\""));
  CHECK_THROWS_WITH(parse_tool_device("playback:x.csv,"), Contains("no option"));
  CHECK_THROWS_WITH(parse_tool_device("playback:x.csv,scale=big"), Contains("\"big\""));
  CHECK_THROWS_WITH(parse_tool_device("playback:x.csv,scale=nan"), Contains("\"nan\""));
  CHECK_THROWS_WITH(parse_tool_device("playback:x.csv,offset=1/2"), Contains("offset=X/Y/Z"));
  CHECK_THROWS_WITH(parse_tool_device("playback:x.csv,rate=0"), Contains("above 0"));
  CHECK_THROWS_WITH(parse_tool_device("virtual_hand:x.csv,scale=2"), Contains("no options"));
}

TEST_CASE("The motion file of a device is named anew, its options stay") {
  CHECK(with_motion_file("playback:x.csv,rate=2,scale=3", "/a/b.csv") == "playback:/a/b.csv,rate=2,scale=3");
  CHECK(with_motion_file("virtual_hand:x.csv", "/a/b.csv") == "virtual_hand:/a/b.csv");
  CHECK_THROWS_WITH(with_motion_file("playback:x.csv", "/a,b/x.csv"), Contains("comma"));
}
