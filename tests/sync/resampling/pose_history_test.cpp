// Tests of interpolating and predicting reported poses.
#include "sync/resampling/pose_history.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <tactus/tool_state_t.hpp>

#include "lcmtypes/vectors.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kMs;

namespace {

constexpr std::int64_t kPoseRun = 3;

// A head that moves along +x at 2 m/s and rotates about z at 1 rad/s.
double angle_at(double s) { return 1.0 * s; }
tool_state_t head_at(std::int64_t host_ns, std::int64_t incarnation = 9) {
  const double s = 1e-9 * static_cast<double>(host_ns);
  tool_state_t m{};
  m.header.run_id = kPoseRun;
  m.header.incarnation = incarnation;
  m.header.sim_time_ns = -1;
  m.header.publish_time_ns = host_ns;
  m.device.position_m = to_vec3({2 * s, 0.5, 0});
  m.device.orientation = to_quat(Eigen::Quaterniond(Eigen::AngleAxisd(angle_at(s), Eigen::Vector3d::UnitZ())));
  m.device_velocity_m_s = to_vec3f({2, 0, 0});
  m.device_spin_rad_s = to_vec3f({0, 0, 1});
  return m;
}

struct Heard {
  PoseHistory history{kPoseRun};
  // A report every 4 ms, each with a latency of 1 ms.
  explicit Heard(std::int64_t until_ms = 400) {
    for (std::int64_t t = 0; t <= until_ms * kMs; t += 4 * kMs) history.push(head_at(t), host_time(t + kMs));
  }
  auto at(double ms) const { return history.at(host_time(static_cast<std::int64_t>(ms * 1e6))); }
};

double error_m(const Sample<BodyPose>& s, double ms) {
  return (s.value.position - Eigen::Vector3d(2e-3 * ms, 0.5, 0)).norm();
}
double error_rad(const Sample<BodyPose>& s, double ms) {
  return s.value.orientation.angularDistance(
      Eigen::Quaterniond(Eigen::AngleAxisd(angle_at(1e-3 * ms), Eigen::Vector3d::UnitZ())));
}

}  // namespace

TEST_CASE("An empty history has no pose") {
  CHECK(PoseHistory(kPoseRun).at(host_time(kMs)).status == SampleStatus::kNone);
}

TEST_CASE("A pose is exact at a report and interpolated between reports") {
  const Heard h;
  CHECK(h.at(200).status == SampleStatus::kExact);
  for (const double ms : {100.0, 101.0, 102.5, 399.9}) {
    const auto s = h.at(ms);
    CHECK(error_m(s, ms) < 1e-9);
    CHECK(error_rad(s, ms) < 1e-7);
  }
  CHECK(h.at(101).status == SampleStatus::kInterpolated);
}

TEST_CASE("After the newest report a pose is extrapolated for 20 ms, then held, and stale after 200 ms") {
  const Heard h;
  const auto soon = h.at(415);
  CHECK(soon.status == SampleStatus::kExtrapolated);
  CHECK(error_m(soon, 415) < 1e-6);
  CHECK(error_rad(soon, 415) < 1e-6);
  const auto later = h.at(500);
  CHECK(later.status == SampleStatus::kHeld);
  CHECK(error_m(later, 420) < 1e-6);
  const auto lost = h.at(10'000);
  CHECK(lost.status == SampleStatus::kStale);
  CHECK(error_m(lost, 400) < 1e-6);  // the last known position
}

TEST_CASE("One second of history is kept, and the oldest pose is held before it") {
  const Heard h(3000);
  CHECK(error_m(h.at(2100), 2100) < 1e-9);
  CHECK(h.at(1000).status == SampleStatus::kHeld);
}

TEST_CASE("A late report and a second process change nothing, and a successor replaces the history") {
  Heard h;
  h.history.push(head_at(100 * kMs), host_time(402 * kMs));
  CHECK(h.at(400).status == SampleStatus::kExact);
  h.history.push(head_at(404 * kMs, 10), host_time(405 * kMs));
  CHECK(h.at(300).status != SampleStatus::kHeld);
  CHECK(h.at(400).status == SampleStatus::kExact);
  CHECK(h.history.conflict(host_time(405 * kMs)));
  h.history.push(head_at(704 * kMs, 10), host_time(705 * kMs));
  CHECK(h.at(300).status == SampleStatus::kHeld);
  CHECK(h.at(704).status == SampleStatus::kExact);
}

TEST_CASE("clear() removes all poses, and later poses are not interpolated with them") {
  Heard h;
  REQUIRE(h.at(200).status == SampleStatus::kExact);
  h.history.clear();
  CHECK(h.at(200).status == SampleStatus::kNone);
  h.history.push(head_at(404 * kMs), host_time(405 * kMs));
  CHECK(h.at(404).status == SampleStatus::kExact);
  const auto before = h.at(402);  // between two reports, if the first of them were still in the history
  CHECK(before.status == SampleStatus::kHeld);
  CHECK(error_m(before, 404) < 1e-9);
}

TEST_CASE("A replayed log is read by arrival") {
  PoseHistory history(kPoseRun);
  for (std::int64_t t = 0; t <= 200 * kMs; t += 4 * kMs) {
    tool_state_t m = head_at(t);
    m.header.run_id = kPoseRun + 1;
    history.push(m, host_time(t + 5'000 * kMs));
  }
  const auto s = history.at(host_time(5'101 * kMs));
  CHECK(s.status == SampleStatus::kInterpolated);
  CHECK(error_m(s, 101) < 1e-4);
}

TEST_CASE("A history is as long as the delay of its view, for every delay of a minute") {
  for (const std::int64_t delay_ms : {0, 900, 1500, 10'000, 60'000}) {
    PoseHistory history{kPoseRun};
    history.extend_history(Nanoseconds(delay_ms * kMs));
    const std::int64_t until_ms = delay_ms + 2000;
    for (std::int64_t t = 0; t <= until_ms * kMs; t += 4 * kMs) history.push(head_at(t), host_time(t + kMs));
    const auto shown = history.at(host_time((until_ms - delay_ms) * kMs));
    CHECK((shown.status == SampleStatus::kExact || shown.status == SampleStatus::kInterpolated));
    CHECK(error_m(shown, static_cast<double>(until_ms - delay_ms)) < 1e-6);
  }
}
