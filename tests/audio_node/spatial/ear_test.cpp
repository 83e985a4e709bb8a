#include "audio_node/spatial/ear.h"

#include <catch2/catch.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/tool_state_t.hpp>

#include "lcmtypes/vectors.h"
#include "sync/clocks/clock_maps.h"

using namespace tactus;
using namespace tactus::audio;

namespace {

scene_t with_head(double listener_x_m) {
  scene_t s{};
  tool_def_t other{}, head{};
  other.name = "hand", head.name = "head";
  s.tools = {other, head}, s.tool_count = 2;
  s.camera = to_pose(Eigen::Isometry3d::Identity());
  s.listener = to_pose(Eigen::Isometry3d(Eigen::Translation3d(listener_x_m, 0, 0)));
  return s;
}

constexpr std::int64_t kRun = 3;

tool_state_t report(std::int32_t tool, double y_m, std::int64_t ns) {
  tool_state_t m{};
  m.header.run_id = kRun;
  m.header.sim_time_ns = -1;
  m.header.publish_time_ns = ns;
  m.tool = tool;
  m.device = to_pose(Eigen::Isometry3d(Eigen::Translation3d(0, y_m, 0)));
  return m;
}

}  // namespace

TEST_CASE(
    "The ear is at the listener of the scene until the head is reported, and then at the last pose of the head") {
  Ear ear(kRun);
  constexpr std::int64_t kMs = 1'000'000;
  ear.set_scene(with_head(2));
  const auto place = [&](std::int64_t ms) {
    return Eigen::Vector3d(ear.at(sync::host_time(ms * kMs)).translation());
  };
  CHECK(place(100).isApprox(Eigen::Vector3d(2, 0, 0)));
  ear.push(report(0, 9, 101 * kMs), sync::host_time(101 * kMs));  // a hand is not a head
  CHECK(place(101).isApprox(Eigen::Vector3d(2, 0, 0)));
  ear.push(report(1, 5, 102 * kMs), sync::host_time(102 * kMs));
  // 2 m beside the eye, as in the scene.
  CHECK(place(102).isApprox(Eigen::Vector3d(2, 5, 0)));
  CHECK(place(9000).isApprox(Eigen::Vector3d(2, 5, 0)));  // lost: at its last place

  ear.set_scene(with_head(3));
  CHECK(place(9001).isApprox(Eigen::Vector3d(3, 0, 0)));  // of another scene
}
