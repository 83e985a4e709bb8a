// Tests of parsing the device of a tool.
#include "lcmtypes/tool_device.h"

#include <catch2/catch.hpp>

using namespace tactus;
using Catch::Contains;

TEST_CASE("A tool device is parsed completely without access to its file") {
  CHECK(parse_tool_device("virtual_hand").kind == ToolDevice::Kind::kVirtualHand);
  CHECK(parse_tool_device("virtual_hand").file.empty());
  CHECK(parse_tool_device("virtual_hand:a b.csv").file == "a b.csv");
  const ToolDevice device = parse_tool_device("playback:no/such.csv,scale=0.5,offset=1/-2/0.5,rate=2");
  CHECK(device.kind == ToolDevice::Kind::kPlayback);
  CHECK(device.file == "no/such.csv");
  CHECK(device.placement.scale == 0.5);
  CHECK(device.placement.offset_m == Eigen::Vector3d(1, -2, 0.5));
  CHECK(device.placement.rate == 2);
  const ToolDevice strings = parse_tool_device("spidar:cave,offset=0/1/2");
  CHECK(strings.kind == ToolDevice::Kind::kSpidar);
  CHECK(strings.name == "cave");
  CHECK(strings.file.empty());
  CHECK(strings.placement.offset_m == Eigen::Vector3d(0, 1, 2));
  CHECK(parse_tool_device("spidar:frames/mine.json").file == "frames/mine.json");
  CHECK(parse_tool_device("external:left arm").kind == ToolDevice::Kind::kExternal);
  CHECK(parse_tool_device("external:left arm,offset=0/0/1").name == "left arm");
}

TEST_CASE("An invalid tool device is reported in one sentence") {
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
  CHECK_THROWS_WITH(parse_tool_device("external"), Contains("give the name of its driver"));
  CHECK_THROWS_WITH(parse_tool_device("spidar"), Contains("name the frame"));
  CHECK_THROWS_WITH(parse_tool_device("spidar:cave,scale=2"), Contains("no option \"scale\"") && Contains("offset"));
}

TEST_CASE("The motion file of a device is replaced and its options are kept") {
  CHECK(with_device_file("playback:x.csv,rate=2,scale=3", "/a/b.csv") == "playback:/a/b.csv,rate=2,scale=3");
  CHECK(with_device_file("virtual_hand:x.csv", "/a/b.csv") == "virtual_hand:/a/b.csv");
  CHECK_THROWS_WITH(with_device_file("playback:x.csv", "/a,b/x.csv"), Contains("comma"));
}
