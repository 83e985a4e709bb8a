// Tests of interpolating body poses.
#include "sync/resampling/body_history.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <tactus/body_state_t.hpp>
#include <tactus/world_state_t.hpp>

#include "lcmtypes/vectors.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kMs;

namespace {

world_state_t page(std::int64_t sim_ns, int body, const Eigen::Vector3d& x, const Eigen::Vector3d& v,
                   double angle = 0, std::int64_t incarnation = 1) {
  world_state_t m{};
  m.header.sim_time_ns = sim_ns;
  m.header.publish_time_ns = sim_ns + 1'000 * kMs;
  m.header.run_id = 1;
  m.header.incarnation = incarnation;
  m.clock = {sim_ns, sim_ns + 1'000 * kMs, 1};
  m.pages = 1;
  body_state_t b{};
  b.body = body;
  b.position_m = to_vec3(x);
  b.orientation = to_quatf(Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ())));
  b.velocity_m_s = to_vec3f(v);
  m.bodies = {b};
  m.count = 1;
  return m;
}

HostTime read_at(std::int64_t sim_ns) { return host_time(sim_ns + 1'000 * kMs); }

}  // namespace

TEST_CASE("The path of a thrown body is interpolated exactly between snapshots") {
  // A cubic through both ends with both velocities reproduces any parabola: only float velocities differ (1e-7 relative).
  const auto x = [](double t) { return Eigen::Vector3d(2 * t, 0, 3 * t - 4.9 * t * t); };
  const auto v = [](double t) { return Eigen::Vector3d(2, 0, 3 - 9.8 * t); };
  BodyHistory history(1);
  for (int i = 0; i < 10; ++i) history.push(page(i * 16 * kMs, 3, x(i * 0.016), v(i * 0.016)), read_at(i * 16 * kMs));
  for (double t = 0.001; t < 0.14; t += 0.0037) {
    const auto s = history.pose(3, SimTime(from_seconds(t)));
    CHECK(s.status == SampleStatus::kInterpolated);
    CHECK((s.value.position - x(t)).norm() < 1e-7);
  }
}

TEST_CASE("A rotation is interpolated along the shorter arc") {
  BodyHistory history(1);
  history.push(page(0, 0, {0, 0, 0}, {0, 0, 0}, 3.0), read_at(0));
  history.push(page(10 * kMs, 0, {0, 0, 0}, {0, 0, 0}, 3.4), read_at(10 * kMs));
  const auto s = history.pose(0, sim_time(5 * kMs));
  const double angle = 2 * std::atan2(s.value.orientation.z(), s.value.orientation.w());
  CHECK(std::abs(std::remainder(angle - 3.2, 2 * M_PI)) < 1e-6);
}

TEST_CASE("After the newest snapshot a body is extrapolated for 50 ms, then held, then stale") {
  BodyHistory history(1);
  history.push(page(0, 0, {1, 0, 0}, {2, 0, 0}), read_at(0));
  CHECK(history.pose(0, sim_time(0)).status == SampleStatus::kExact);
  const auto moving = history.pose(0, sim_time(40 * kMs));
  CHECK(moving.status == SampleStatus::kExtrapolated);
  CHECK(moving.value.position.x() == Approx(1.08));
  const auto held = history.pose(0, sim_time(150 * kMs));
  CHECK(held.status == SampleStatus::kHeld);
  CHECK(held.value.position.x() == Approx(1.1));
  CHECK(history.pose(0, sim_time(300 * kMs)).status == SampleStatus::kStale);
}

TEST_CASE("A body that newer snapshots omit rests where it was") {
  BodyHistory history(1);
  history.push(page(0, 0, {1, 2, 3}, {0, 0, 0}), read_at(0));
  for (int i = 1; i < 50; ++i) history.push(page(i * 16 * kMs, 1, {0, 0, 0}, {0, 0, 0}), read_at(i * 16 * kMs));
  const auto s = history.pose(0, sim_time(49 * 16 * kMs));
  CHECK(s.value.position.isApprox(Eigen::Vector3d(1, 2, 3)));
  CHECK(s.status == SampleStatus::kInterpolated);
}

TEST_CASE("A moving body with a lost page is extrapolated, then held, then stale") {
  BodyHistory history(1);
  history.push(page(0, 0, {1, 2, 3}, {2, 0, 0}), read_at(0));
  for (int i = 1; i < 50; ++i) history.push(page(i * 16 * kMs, 1, {0, 0, 0}, {0, 0, 0}), read_at(i * 16 * kMs));
  const auto s = history.pose(0, sim_time(16 * kMs));
  CHECK(s.value.position.x() == Approx(1.032));
  CHECK(s.status == SampleStatus::kExtrapolated);
  CHECK(history.pose(0, sim_time(100 * kMs)).status == SampleStatus::kHeld);
  CHECK(history.pose(0, sim_time(300 * kMs)).status == SampleStatus::kStale);
}

TEST_CASE("A restart of the simulation removes all old poses") {
  BodyHistory history(1);
  history.push(page(900 * kMs, 0, {1, 0, 0}, {0, 0, 0}), read_at(900 * kMs));
  history.push(page(0, 1, {0, 0, 0}, {0, 0, 0}, 0, 2), read_at(980 * kMs));
  CHECK(history.pose(0, sim_time(0)).status == SampleStatus::kNone);
  CHECK(history.pose(1, sim_time(0)).status == SampleStatus::kExact);
}

TEST_CASE("A page far in the future is rejected, and the next valid one is accepted") {
  BodyHistory history(1);
  history.push(page(0, 0, {1, 0, 0}, {0, 0, 0}), read_at(0));
  world_state_t forged = page(0, 0, {9, 9, 9}, {0, 0, 0});
  forged.header.sim_time_ns = 3'600'000 * kMs;
  history.push(forged, read_at(0));
  CHECK(history.refused() == 1);
  history.push(page(16 * kMs, 0, {2, 0, 0}, {0, 0, 0}), read_at(16 * kMs));
  CHECK(history.pose(0, sim_time(16 * kMs)).value.position.x() == 2);
  CHECK(history.status(sim_time(300 * kMs)) == SampleStatus::kStale);
}

TEST_CASE("A forged first page is discarded after contradicting pages") {
  BodyHistory history(1);
  world_state_t forged = page(3'600'000 * kMs, 0, {9, 9, 9}, {0, 0, 0});
  forged.header.publish_time_ns = forged.clock.host_ns = 1'000 * kMs;
  history.push(forged, read_at(0));
  for (int ms = 16; ms <= 320; ms += 16) history.push(page(ms * kMs, 0, {1, 0, 0}, {0, 0, 0}), read_at(ms * kMs));
  CHECK(history.pose(0, sim_time(320 * kMs)).value.position.x() == 1);
  CHECK(history.status(sim_time(600 * kMs)) == SampleStatus::kStale);
}

TEST_CASE("A body id beyond the limit is rejected") {
  BodyHistory history(1);
  history.push(page(0, BodyHistory::kMaxBodies, {1, 0, 0}, {0, 0, 0}), read_at(0));
  CHECK(history.refused() == 1);
  CHECK(history.pose(BodyHistory::kMaxBodies, sim_time(0)).status == SampleStatus::kNone);
}

TEST_CASE("Poses are kept for a modality that presents up to 20 s late") {
  BodyHistory history(1);
  const std::int64_t late = GENERATE(500, 5'000, 20'000) * kMs;
  for (std::int64_t i = 0; i < 60 * 30; ++i) {
    const std::int64_t now = i * 16 * kMs, then = now - late;
    history.extend_history(Nanoseconds(late));
    history.push(page(now, 0, {1e-9 * static_cast<double>(now), 0, 0}, {1, 0, 0}), read_at(now));
    if (then < 0) continue;
    const auto s = history.pose(0, sim_time(then));
    REQUIRE((s.status == SampleStatus::kExact || s.status == SampleStatus::kInterpolated));
    REQUIRE(s.value.position.x() == Approx(1e-9 * static_cast<double>(then)).margin(1e-6));
  }
}
