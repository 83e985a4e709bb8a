#include "visual_node/scene_view/flashes.h"

#include <catch2/catch.hpp>
#include <random>
#include <tactus/contact_event_t.hpp>

using namespace tactus;
using namespace tactus::visual;
using std::chrono::milliseconds;

namespace {

contact_event_t hit(std::int64_t id, double distance_m = 1) {
  contact_event_t e{};
  e.event_id = id;
  e.kind = contact_event_t::HIT;
  e.point_m.x = static_cast<float>(distance_m);
  e.normal.z = 1;
  e.approach_speed_m_s = 1;
  return e;
}

Camera camera() { return make_camera(Eigen::Isometry3d::Identity(), 1, 640, 480, 0.01, 100); }

}  // namespace

TEST_CASE("A contact flashes for at least three frames and the set duration at any frame rate") {
  Settings settings;
  settings.flash_duration_s = 0.08;
  std::mt19937 random(3);
  std::uniform_int_distribution<int> period(1, 200);
  for (int trial = 0; trial < 200; ++trial) {
    Flashes flashes(settings);
    const sync::HostTime first = sync::host_time(1'000'000'000);
    sync::HostTime t = first;
    flashes.add(hit(1), t);
    int frames = 0;
    sync::HostTime last{};
    for (int i = 0; i < 200; ++i) {
      if (!flashes.frame(t, camera()).empty()) ++frames, last = t;
      t += milliseconds(period(random));
    }
    CHECK(frames >= 3);
    CHECK(last - first < milliseconds(80 + 3 * 200));
    // Shown in every frame within its duration.
    if (frames > 3) CHECK(last - first < milliseconds(80));
  }
}

TEST_CASE("A flash grows, fades, is brighter for a faster hit and has a minimum size") {
  const Settings settings;
  Flashes flashes(settings);
  const sync::HostTime t = sync::host_time(0);
  flashes.add(hit(1), t);
  const Glow young = flashes.frame(t, camera()).front(),
             old = flashes.frame(t + milliseconds(60), camera()).front();
  CHECK(old.u.norm() > young.u.norm());
  CHECK(old.colour.norm() < young.colour.norm());

  SECTION("a faster hit is brighter") {
    Flashes slow(settings);
    contact_event_t e = hit(2);
    e.approach_speed_m_s = 0.3f;
    slow.add(e, t);
    CHECK(slow.frame(t, camera()).front().colour.norm() < young.colour.norm());
  }
  SECTION("a distant flash covers the minimum number of pixels") {
    Flashes far(settings);
    far.add(hit(3, 50), t);
    const Glow glow = far.frame(t + sync::from_seconds(settings.flash_duration_s), camera()).front();
    CHECK(glow.u.head<3>().norm() * camera().focal_px / 50 == Approx(settings.flash_pixels).epsilon(0.01));
  }
}

TEST_CASE("The ring of a flash lies in the plane of contact") {
  Flashes flashes{Settings{}};
  contact_event_t e = hit(1);
  e.normal.x = 0.6f, e.normal.y = 0, e.normal.z = 0.8f;
  flashes.add(e, sync::host_time(0));
  const Glow ring = flashes.frame(sync::host_time(0), camera()).front();
  const Eigen::Vector3f normal(0.6f, 0, 0.8f);
  CHECK(std::abs(ring.u.head<3>().dot(normal)) < 1e-6f);
  CHECK(std::abs(ring.v.head<3>().dot(normal)) < 1e-6f);
}

TEST_CASE("The events of the last frame are reported newest first") {
  Flashes flashes{Settings{}};
  for (const int id : {4, 5, 6}) flashes.add(hit(id), sync::host_time(0));
  flashes.frame(sync::host_time(0), camera());
  CHECK(flashes.shown() == std::vector<std::int64_t>{6, 5, 4});
}
