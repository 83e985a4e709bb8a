// A face in contact at more places than a message holds.
#include <catch2/catch.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_constraint_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

TEST_CASE("The largest contacts carry the whole force when there are more contacts than a message holds") {
  scene_t box = scene();
  box.tools[0].shape = tool_def_t::BOX;
  box.tools[0].radius_m = 0.04;
  Settings settings;
  settings.rendering = GENERATE("rigid", "direct");
  INFO(settings.rendering);
  Bench bench(settings, box);
  // Under a face of 40 mm, 5 by 5 places of one floor; the hand moves down off the middle.
  std::vector<touch_plane_t> planes;
  for (int i = 0; i < 25; ++i) {
    const Vector3d place(0.01 * (i % 5 - 2), 0.01 * (i / 5 - 2), -0.01);
    auto p = plane(7 + i, {place.x(), place.y(), 0}, Vector3d::UnitZ());
    p.tool_point_m = to_vec3f(place);
    planes.push_back(p);
  }
  std::size_t most = 0;
  for (int ms = 0; ms < 200; ++ms) {
    const touch_model_t m = model(ms, planes);
    const double down = 0.003 * std::min(1.0, ms / 100.0);
    const TickOutput& out = bench.tick(ms, {0.0003, 0.0001, 0.01 - down}, &m);
    Vector3d sum = Vector3d::Zero(), moment = Vector3d::Zero();
    std::size_t acting = 0;
    for (const tool_constraint_t& c : out.state.constraints) {
      const Vector3d f = to_eigen(c.force_N);
      sum += f;
      moment += (to_eigen(c.point_m) - to_eigen(out.state.proxy.position_m)).cross(f);
      acting += !f.isZero(0);
    }
    most = std::max(most, acting);
    CHECK((sum - out.force_N).norm() < 1e-5);
    CHECK((moment - out.torque_N_m).norm() < 1e-4);
  }
  CHECK(bench.tick(200, {0.0003, 0.0001, 0.007}).force_N.z() > 1);
  CHECK(most <= ContactImpulses::kMaxPublished);
  CHECK(most > 2);
}
