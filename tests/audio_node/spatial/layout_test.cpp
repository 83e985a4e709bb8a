#include "audio_node/spatial/layout.h"

#include <catch2/catch.hpp>

using namespace tactus::audio;
using Catch::Contains;

namespace {

const std::string kHead = "channel,azimuth_deg,elevation_deg\n";

}  // namespace

TEST_CASE("A layout has one channel for each row, and a silent one for a row without a direction") {
  const Layout layout = parse_layout(kHead + "left,90,0\r\nlow,,\n\nup,0,90\n", "room.csv");
  REQUIRE(layout.size() == 3);
  CHECK((*layout[0] - Eigen::Vector3d::UnitY()).norm() < 1e-9);
  CHECK_FALSE(layout[1]);
  CHECK((*layout[2] - Eigen::Vector3d::UnitZ()).norm() < 1e-9);
}

TEST_CASE("The built-in layouts have their channels") {
  CHECK(load_layout("stereo").size() == 2);
  CHECK(load_layout("quad").size() == 4);
  CHECK(load_layout("5.1").size() == 6);
  CHECK(load_layout("cube").size() == 8);
}

TEST_CASE("An unusable layout is rejected with a sentence that names the reason") {
  CHECK_THROWS_WITH(load_layout("/nowhere/room.csv"), Contains("/nowhere/room.csv cannot be read; choose stereo"));
  CHECK_THROWS_WITH(load_layout("/dev/zero"), Contains("/dev/zero cannot be read"));  // it has no end
  CHECK_THROWS_WITH(parse_layout("", "room.csv"),
                    Contains("begin in line 1 with channel,azimuth_deg,elevation_deg"));
  CHECK_THROWS_WITH(parse_layout(kHead, "room.csv"), Contains("has no loudspeaker"));
  CHECK_THROWS_WITH(parse_layout(kHead + "low,,\n", "room.csv"), Contains("has no loudspeaker"));
  CHECK_THROWS_WITH(parse_layout(kHead + "left,90\n", "room.csv"), Contains("needs three columns in line 2"));
  CHECK_THROWS_WITH(parse_layout(kHead + "left,90,0\nright,x,0\n", "room.csv"), Contains("degrees in line 3"));
  CHECK_THROWS_WITH(parse_layout(kHead + "left,90,91\n", "room.csv"), Contains("degrees in line 2"));
  CHECK_THROWS_WITH(parse_layout(kHead + "left,nan,0\n", "room.csv"), Contains("degrees in line 2"));
  std::string many = kHead;
  for (int i = 0; i < 33; ++i) many += "x,0,0\n";
  CHECK_THROWS_WITH(parse_layout(many, "room.csv"), Contains("more than 32 channels"));
}
