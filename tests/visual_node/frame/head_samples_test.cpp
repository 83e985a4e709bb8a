#include "visual_node/frame/head_samples.h"

#include <catch2/catch.hpp>
#include <optional>
#include <tactus/tool_state_t.hpp>

#include "lcmtypes/vectors.h"

using namespace tactus;
using namespace tactus::visual;
using std::chrono::milliseconds;

namespace {

constexpr RoomTime kBegin = room_time(10'000'000'000);

// Arrival of a message that was sent then; the own clock is an hour ahead of the room's.
sync::HostTime arrival(RoomTime sent) { return sync::host_time(sync::to_ns(sent) + 3'600'000'000'000); }

tool_state_t head(std::int64_t publish_ns, double x_m, double speed_m_s = 0, double spin_rad_s = 0) {
  tool_state_t m{};
  m.header.publish_time_ns = publish_ns, m.header.incarnation = 4;
  m.device.position_m.x = x_m, m.device.orientation.w = 1;
  m.device_velocity_m_s.x = static_cast<float>(speed_m_s);
  m.device_spin_rad_s.z = static_cast<float>(spin_rad_s);
  return m;
}

}  // namespace

TEST_CASE("The newest head sample published by a time is used, regardless of later ones") {
  HeadSamples samples;
  CHECK_FALSE(samples.published_by(kBegin));
  for (int i = 0; i < 100; ++i) samples.push(head(500 + i, i), kBegin + milliseconds(i), arrival(kBegin + milliseconds(i)));
  CHECK_FALSE(samples.published_by(kBegin - milliseconds(1)));
  CHECK(samples.published_by(kBegin + milliseconds(30))->publish_ns == 530);
  CHECK(samples.published_by(kBegin + milliseconds(31) - sync::Nanoseconds(1))->publish_ns == 530);
  CHECK(samples.published_by(kBegin + milliseconds(5000))->publish_ns == 599);
}

TEST_CASE("A head sample is extrapolated with its velocity and spin for a limited time") {
  HeadSamples samples;
  samples.push(head(1, 2, 0.5, 1.5), kBegin, arrival(kBegin));
  const HeadSample s = *samples.published_by(kBegin);
  CHECK(extrapolate(s, kBegin).status == sync::SampleStatus::kExact);
  const auto soon = extrapolate(s, kBegin + milliseconds(20));
  CHECK(soon.status == sync::SampleStatus::kExtrapolated);
  CHECK(soon.value.position.x() == Approx(2.01).margin(1e-9));
  CHECK(soon.value.orientation.angularDistance(Eigen::Quaterniond::Identity()) == Approx(0.03).margin(1e-7));
  const auto later = extrapolate(s, kBegin + milliseconds(150));
  CHECK(later.status == sync::SampleStatus::kHeld);
  CHECK(later.value.position.x() == Approx(2.025).margin(1e-9));
  CHECK(extrapolate(s, kBegin + milliseconds(201)).status == sync::SampleStatus::kStale);
}

TEST_CASE("A clock step back clears the samples of the head, and their number is limited") {
  HeadSamples samples;
  const sync::HostTime now = arrival(kBegin);
  for (int i = 0; i < 10'000; ++i) samples.push(head(i, 0), kBegin + sync::Nanoseconds(i * 1000), now);
  CHECK_FALSE(
      samples.published_by(kBegin + sync::Nanoseconds(1000 * (10'000 - 1 - static_cast<int>(HeadSamples::kMax)))));
  CHECK(samples.published_by(kBegin + milliseconds(9)));
  samples.push(head(7, 0), kBegin - milliseconds(2000), now);
  CHECK(samples.published_by(kBegin)->publish_ns == 7);
}

TEST_CASE("A second process of the head changes nothing while the first one sends, and takes over after its silence") {
  HeadSamples samples;
  const auto second = [](std::int64_t publish_ns) {
    tool_state_t m = head(publish_ns, 99);
    m.header.incarnation = 5;
    return m;
  };
  for (int ms = 0; ms < 1000; ++ms) {
    const RoomTime t = kBegin + milliseconds(ms);
    samples.push(head(ms, 0), t, arrival(t));
    if (ms % 3 == 1) samples.push(second(ms), t + sync::Nanoseconds(1000), arrival(t));
    CHECK(samples.published_by(t + milliseconds(1))->pose.position.x() == 0);
    CHECK(samples.conflict(arrival(t)) == (ms >= 1));
  }
  // The first one ends.
  std::optional<int> taken_ms;
  for (int ms = 1000; ms < 1400; ++ms) {
    const RoomTime t = kBegin + milliseconds(ms);
    samples.push(second(ms), t, arrival(t));
    if (!taken_ms && samples.published_by(t)->pose.position.x() == 99) taken_ms = ms;
  }
  REQUIRE(taken_ms);
  CHECK(*taken_ms == 1299);  // 300 ms after its last message
  // Its samples are gone.
  CHECK_FALSE(samples.published_by(kBegin + milliseconds(999)));
  CHECK_FALSE(samples.conflict(arrival(kBegin + milliseconds(1700))));
}

TEST_CASE("The head of a view that a profile delays by more than a second is known") {
  for (const int delay_ms : {0, 1500, 60'000}) {
    HeadSamples samples;
    samples.extend_history(milliseconds(delay_ms));
    for (int i = 0; i <= delay_ms + 2000; i += 4) samples.push(head(500 + i, i), kBegin + milliseconds(i), arrival(kBegin + milliseconds(i)));
    const auto shown = samples.published_by(kBegin + milliseconds(2000));
    REQUIRE(shown);
    CHECK(shown->publish_ns == 2500);
  }
}
