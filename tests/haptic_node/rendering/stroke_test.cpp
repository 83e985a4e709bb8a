// A stroke over a bumpy sphere of flat facets, with touch models as the simulation makes them: the plane of the
// facet nearest to the proxy, slightly late.
#include <catch2/catch.hpp>
#include <cmath>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

constexpr double kRadius_m = 0.05, kBump_m = 0.0003, kFacet_rad = 5 * M_PI / 180;

// Facets of 5 degrees in latitude and longitude; each is higher or lower than a sphere by up to 0.3 mm.
touch_plane_t facet_under(const Vector3d& place) {
  const Vector3d u = place.normalized();
  const double latitude = std::round(std::asin(u.z()) / kFacet_rad) * kFacet_rad;
  const double longitude = std::round(std::atan2(u.y(), u.x()) / kFacet_rad) * kFacet_rad;
  const Vector3d n(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                   std::sin(latitude));
  return plane(7, (kRadius_m + kBump_m * std::sin(11 * longitude) * std::cos(7 * latitude)) * n, n, 0.3);
}

}  // namespace

TEST_CASE("A stroke over the facets of a bumpy sphere has no jump of the force") {
  const Settings settings;
  Bench bench(settings);
  const double tool = 0.005, depth = 0.003, speed = GENERATE(0.02, 0.1, 0.3);
  std::array<touch_model_t, 3> late;
  Vector3d last_force = Vector3d::Zero(), proxy(kRadius_m + tool + 0.001, 0, 0);
  double worst = 0, mean = 0;
  int pressed = 0;
  const int ticks = static_cast<int>(M_PI * kRadius_m / speed * 1000);
  for (int ms = 0; ms < ticks; ++ms) {
    const double angle = speed / kRadius_m * ms * 1e-3;
    const double inwards = std::min(1.0, ms / 100.0);  // moves in over the first tenth of a second
    const double r = kRadius_m + tool + 0.001 - (depth + 0.001) * inwards;
    const Vector3d device = r * Vector3d(std::cos(angle), std::sin(angle), 0.4 * std::sin(3 * angle)).normalized();
    late[ms % 3] = model(ms, {facet_under(proxy)});
    const auto& out = bench.tick(ms, device, ms >= 2 ? &late[(ms + 1) % 3] : nullptr);
    proxy = to_eigen(out.state.proxy.position_m);
    worst = std::max(worst, (out.force_N - last_force).norm());
    last_force = out.force_N;
    if (ms < 200) continue;
    mean += out.force_N.norm();
    ++pressed;
  }
  mean /= pressed;
  CAPTURE(speed, mean, worst);
  // 3 mm under 1 N/mm, with friction; the surface is up to 0.3 mm higher or lower.
  CHECK(mean > 2.0);
  CHECK(mean < 4.5);
  // Per tick: a pressed facet yields by 0.1 mm (0.1 N) and turns by 30 rad/s (0.03 mean), friction follows twice
  // with its coefficient, and the damper of at most b/2 sees the change of speed by the rotation: 5 N s/m * speed
  // * 0.03. Facets meet at up to 7 degrees and are up to 0.6 mm apart; a step of that in 15 ticks is 0.04 mm.
  CHECK(worst < 1.6 * (0.1 + 0.03 * 4.5) + 5 * speed * 0.1);
}
