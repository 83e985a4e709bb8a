#include "haptic_node/devices/selection/make_device.h"

#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <tactus/tool_def_t.hpp>
#include <tactus/waypoint_t.hpp>

using namespace tactus;
using namespace tactus::haptic;
using Catch::Contains;
using Eigen::Vector3d;

namespace {

struct TemporaryFile {
  TemporaryFile() : path(std::filesystem::temp_directory_path() / "tactus_make_device_test.csv") {
    std::ofstream(path) << "time_s,x_m,y_m,z_m\n0,0.1,0,0\n1,0.2,0,0\n";
  }
  ~TemporaryFile() { std::filesystem::remove(path); }
  std::filesystem::path path;
};

waypoint_t waypoint(double time_s, double x) {
  waypoint_t w{};
  w.time_s = time_s;
  w.position_m.x = x;
  return w;
}
sync::HostTime at_s(double s) { return sync::host_time(7) + sync::from_seconds(s); }

}  // namespace

TEST_CASE("A device specification is parsed completely") {
  const TemporaryFile file;
  CHECK_FALSE(parse_device_spec("virtual_hand").motion);
  CHECK(parse_device_spec("virtual_hand:" + file.path.string()).motion->times_s.size() == 2);
  const DeviceSpec spec =
      parse_device_spec("playback:" + file.path.string() + ",scale=0.5,offset=1/-2/0.5,rate=2");
  CHECK(spec.kind == DeviceSpec::Kind::kPlayback);
  CHECK(spec.placement.scale == 0.5);
  CHECK(spec.placement.offset_m == Vector3d(1, -2, 0.5));
  CHECK(spec.placement.rate == 2);
}

TEST_CASE("An error in a device or its file is reported in one sentence") {
  CHECK_THROWS_WITH(parse_device_spec("phantom"), Contains("phantom") && Contains("use virtual_hand"));
  CHECK_THROWS_WITH(parse_device_spec("playback:/no/such.csv"), Contains("cannot be read"));
}

TEST_CASE("A virtual hand follows the waypoints of its tool") {
  tool_def_t tool{};
  tool.name = "stylus";
  tool.waypoints = {waypoint(0, 0), waypoint(1, 0.1)};
  SECTION("The path is followed once") {
    const auto hand = make_device({}, tool, Vector3d::Zero(), {});
    hand->begin(at_s(0));
    hand->read(at_s(0));
    for (double t = 0.001; t < 3; t += 0.001) hand->read(at_s(t));
    CHECK(hand->read(at_s(3)).position.x() == Approx(0.1));
  }
  SECTION("The path is repeated with a uniform return") {
    tool.loop = 1;
    const auto hand = make_device({}, tool, Vector3d::Zero(), {});
    hand->begin(at_s(0));
    hand->read(at_s(0));
    for (double t = 0.001; t < 1.5; t += 0.001) CHECK(std::abs(hand->read(at_s(t)).velocity.x()) < 0.4);
    CHECK(hand->read(at_s(1.52)).position.x() == Approx(0).margin(1e-3));  // 0.1 m at 0.2 m/s after 1 s
  }
  SECTION("The hand rests without waypoints") {
    tool.waypoints.clear();
    const auto hand = make_device({}, tool, Vector3d(1, 2, 3), {});
    hand->begin(at_s(0));
    hand->read(at_s(0));
    CHECK(hand->read(at_s(1)).position == Vector3d(1, 2, 3));
  }
  SECTION("Waypoints with decreasing times are rejected") {
    tool.waypoints = {waypoint(1, 0), waypoint(0.5, 1)};
    CHECK_THROWS_WITH(make_device({}, tool, Vector3d::Zero(), {}), Contains("stylus") && Contains("sort"));
  }
}
