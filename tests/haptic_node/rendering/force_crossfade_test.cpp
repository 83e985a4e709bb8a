#include "haptic_node/rendering/force_crossfade.h"

#include <catch2/catch.hpp>

#include "haptic_node/contact/proxy.h"
#include "tests/haptic_node/support/tick.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

constexpr double kRecovery_s = 0.015, kAtOnce_N_s = 200;

Surface bound(std::int64_t id, double depth_m = 0.001) {
  Surface s;
  s.contact_id = id;
  s.depth_m = depth_m;
  return s;
}

}  // namespace

TEST_CASE("The force moves to that of other surfaces in even steps within the recovery time") {
  const double dt = GENERATE(1e-3, 0.5e-3, 0.25e-3);
  ForceCrossfade crossfade(kRecovery_s, kAtOnce_N_s);
  const std::vector<Surface> before{bound(1), bound(2, 0)}, after{bound(1, 0), bound(2)};
  const Vector3d old(0, 0, 3), next(2, 0, 3);
  for (int i = 0; i < 5; ++i) CHECK(crossfade.step(before, old, dt) == old);
  Vector3d last = old;
  double t = 0;
  for (; t < kRecovery_s - 1e-9; t += dt) {
    const Vector3d force = crossfade.step(after, next, dt);
    // Its share, plus the change that passes in the tick of the transition.
    CHECK((force - last).norm() <= std::max(kAtOnce_N_s * dt, 2 * dt / kRecovery_s) + 1e-12);
    CHECK((force - old).norm() > (last - old).norm() - 1e-12);
    last = force;
  }
  crossfade.step(after, next, dt);
  CHECK((crossfade.step(after, next, dt) - next).norm() < 1e-12);
}

TEST_CASE("The first touch, the release and changes on the same surfaces pass unchanged") {
  ForceCrossfade crossfade(kRecovery_s, kAtOnce_N_s);
  const std::vector<Surface> free{bound(1, 0)}, one{bound(1)};
  CHECK(crossfade.step(free, Vector3d::Zero(), kDt) == Vector3d::Zero());
  CHECK(crossfade.step(one, {0, 0, 4}, kDt) == Vector3d(0, 0, 4));
  CHECK(crossfade.step(one, {0, 3, 1}, kDt) == Vector3d(0, 3, 1));
  CHECK(crossfade.step(free, Vector3d::Zero(), kDt) == Vector3d::Zero());
  CHECK(crossfade.step(one, {5, 0, 0}, kDt) == Vector3d(5, 0, 0));
}

TEST_CASE("The remaining force of old surfaces is zero when the hand leaves all surfaces") {
  ForceCrossfade crossfade(kRecovery_s, kAtOnce_N_s);
  crossfade.step(std::vector{bound(1)}, {0, 0, 3}, kDt);
  crossfade.step(std::vector{bound(2)}, {3, 0, 0}, kDt);
  CHECK(crossfade.step(std::vector{bound(2, 0)}, Vector3d::Zero(), kDt) == Vector3d::Zero());
  CHECK(crossfade.step(std::vector{bound(2)}, {1, 0, 0}, kDt) == Vector3d(1, 0, 0));
}

TEST_CASE("A small change of the force passes at once") {
  ForceCrossfade crossfade(kRecovery_s, kAtOnce_N_s);
  crossfade.step(std::vector{bound(1)}, {0, 0, 3}, kDt);
  CHECK(crossfade.step(std::vector{bound(1), bound(2)}, {0.1, 0, 3}, kDt) == Vector3d(0.1, 0, 3));
}

TEST_CASE("Friction persists when the tool slides over a shallow groove between two facets") {
  // Facets that meet at 10 degrees in x = 0; the hand crosses them at 0.1 m/s, 3 mm deep.
  const double lean = 5 * M_PI / 180, speed = 0.1;
  std::vector<Surface> groove(2);
  for (int i = 0; i < 2; ++i) {
    Surface& s = groove[static_cast<std::size_t>(i)];
    s.contact_id = i;
    s.normal = Vector3d((i == 0 ? 1 : -1) * std::sin(lean), 0, std::cos(lean));
    s.friction_static = s.friction_dynamic = 0.3;
  }
  Proxy proxy;
  proxy.reset({-0.02, 0, 0.01});
  Vector3d last = Vector3d::Zero();
  bool both = false;
  double largest_m = 0;
  for (int ms = 0; ms < 400; ++ms) {
    const double x = -0.02 + speed * ms * 1e-3;
    const Vector3d device(x, 0, std::abs(x) * std::tan(lean) - 0.003);
    proxy.step(groove, device, kDt);
    const Vector3d stretch = proxy.position() - device;
    both = both || (groove[0].depth_m > 0 && groove[1].depth_m > 0);
    if (ms > 50) largest_m = std::max(largest_m, (stretch - last).norm());
    last = stretch;
    // Only the dynamic friction cone leans back, for any binding facets.
    if (ms > 50) CHECK(proxy.shift().x() < -0.2 * 0.003);
  }
  REQUIRE(both);
  // No step exceeds that of the hand: its motion in a tick and the rotation of the normal spread over the groove.
  CHECK(largest_m < 2 * speed * kDt);
}
