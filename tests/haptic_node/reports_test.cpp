#include <catch2/catch.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/tool_constraint_t.hpp>

#include "haptic_node/contact/contact_impulses.h"
#include "haptic_node/contact/pending_onsets.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {
const sync::Nanoseconds kUncertain{500'000};
ContactForce felt(std::int64_t id, double newton) { return {id, 0, Vector3d::Zero(), {0, 0, newton}}; }
}  // namespace

TEST_CASE("Contact impulses sum force over time per contact, including the last tick") {
  ContactImpulses impulses;
  std::vector<tool_constraint_t> published;
  for (int ms = 0; ms < 10; ++ms) impulses.step(host_ms(ms), 1e-3, std::vector{felt(7, 2)});
  impulses.write_constraints(host_ms(9), published);
  REQUIRE(published.size() == 1);
  CHECK(published[0].impulse_N_s.z == Approx(9 * 2e-3));  // impulse so far
  CHECK(published[0].force_N.z == Approx(2));
  impulses.step(host_ms(10), 1e-3, {});
  impulses.write_constraints(host_ms(10), published);
  REQUIRE(published.size() == 1);
  CHECK(published[0].impulse_N_s.z == Approx(10 * 2e-3));
  CHECK(published[0].force_N.z == 0);
  impulses.step(host_ms(70), 1e-3, {});
  impulses.write_constraints(host_ms(70), published);
  CHECK(published.empty());
  impulses.step(host_ms(71), 1e-3, std::vector{felt(7, 2)});
  impulses.write_constraints(host_ms(71), published);
  CHECK(published[0].impulse_N_s.z == Approx(10 * 2e-3));  // continues from its value
  CHECK(impulses.first_force_time(7) == host_ms(71));
}

TEST_CASE("The number of contact impulses is bounded, and the oldest contact is removed") {
  ContactImpulses impulses;
  std::vector<tool_constraint_t> published;
  for (int i = 0; i < 1000; ++i) impulses.step(host_ms(i), 1e-3, std::vector{felt(i, 1)});
  CHECK_FALSE(impulses.first_force_time(0));
  CHECK(impulses.first_force_time(999) == host_ms(999));
  impulses.write_constraints(host_ms(999), published);
  CHECK(published.size() == ContactImpulses::kMaxPublished);
  CHECK(published[0].contact_id == 999);
}

TEST_CASE("The begin of a sum of impulses is published, and a removed contact begins another sum") {
  ContactImpulses impulses;
  std::vector<tool_constraint_t> published;
  const auto publish = [&](int ms, int contact) {
    impulses.step(host_ms(ms), 1e-3, std::vector{felt(contact, 1)});
    impulses.write_constraints(host_ms(ms), published);
    return published.at(0);
  };
  CHECK(publish(5, 0).impulse_since_ns == sync::to_ns(host_ms(5)));
  CHECK(publish(6, 0).impulse_since_ns == sync::to_ns(host_ms(5)));
  CHECK(publish(200, 0).impulse_since_ns == sync::to_ns(host_ms(5)));  // the sum continues after a pause
  for (int i = 1; i <= 200; ++i) publish(200 + i, i);
  const tool_constraint_t again = publish(500, 0);
  CHECK(again.impulse_since_ns == sync::to_ns(host_ms(500)));
  CHECK(again.impulse_N_s.z == 0);
}

TEST_CASE("A begin is presented at its first force, before or after the event arrives") {
  ContactImpulses impulses;
  PendingOnsets onsets;
  std::vector<presentation_t> reports;
  impulses.step(host_ms(5), 1e-3, std::vector{felt(7, 1)});
  onsets.add(1, 7, host_ms(6), host_ms(8), true, reports);
  onsets.add(2, 8, host_ms(8), host_ms(8), true, reports);
  onsets.step(host_ms(8), impulses, kUncertain, reports);
  REQUIRE(reports.size() == 1);
  CHECK(reports[0].event_id == 1);
  CHECK(reports[0].presented_ns == sync::to_ns(host_ms(5)));
  CHECK(reports[0].scheduled_ns == sync::to_ns(host_ms(6)));
  CHECK(reports[0].part == presentation_t::CONSTRAINT);
  impulses.step(host_ms(20), 1e-3, std::vector{felt(8, 1)});
  onsets.step(host_ms(20), impulses, kUncertain, reports);
  REQUIRE(reports.size() == 2);
  CHECK(reports[1].presented_ns == sync::to_ns(host_ms(20)));
  onsets.step(host_ms(300), impulses, kUncertain, reports);
  CHECK(reports.size() == 2);
}

TEST_CASE("A begin without force is reported once, by whether its surface was known") {
  const ContactImpulses impulses;
  PendingOnsets onsets;
  std::vector<presentation_t> reports;
  onsets.add(1, 7, host_ms(6), host_ms(8), true, reports);
  onsets.add(2, 8, host_ms(6), host_ms(8), false, reports);
  onsets.step(host_ms(107), impulses, kUncertain, reports);
  CHECK(reports.empty());
  onsets.step(host_ms(108), impulses, kUncertain, reports);
  REQUIRE(reports.size() == 2);
  CHECK(reports[0].outcome == presentation_t::PRESENTED);
  CHECK(reports[0].presented_ns == sync::to_ns(host_ms(8)));
  CHECK(reports[1].outcome == presentation_t::DROPPED_LATE);
  CHECK(reports[1].presented_ns == -1);
}

TEST_CASE("Begins beyond the queue capacity are reported at once, and none is lost") {
  const ContactImpulses impulses;
  PendingOnsets onsets;
  std::vector<presentation_t> reports;
  for (int i = 0; i < 500; ++i) onsets.add(i, i, host_ms(0), host_ms(0), false, reports);
  onsets.step(host_ms(1000), impulses, kUncertain, reports);
  CHECK(reports.size() == 500);
}
