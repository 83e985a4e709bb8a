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

namespace {

// A tick in which the rendered world is this many ms old.
PendingOnsets::Rendered tick(int now_ms, int age_ms, bool known, int delay_ms = 0) {
  return {.now = host_ms(now_ms),
          .shown = host_ms(now_ms - age_ms),
          .delay = sync::Nanoseconds(delay_ms * 1'000'000LL),
          .uncertainty = kUncertain,
          .surface_known = [known](std::int64_t) { return known; }};
}

}  // namespace

TEST_CASE("A begin is presented at its first force, before or after the event arrives") {
  ContactImpulses impulses;
  PendingOnsets onsets;
  std::vector<presentation_t> reports;
  impulses.step(host_ms(5), 1e-3, std::vector{felt(7, 1)});
  onsets.add(1, 7, host_ms(6), host_ms(8), reports);
  onsets.add(2, 8, host_ms(8), host_ms(8), reports);
  onsets.step(tick(8, 1, true), impulses, reports);
  REQUIRE(reports.size() == 1);
  CHECK(reports[0].event_id == 1);
  CHECK(reports[0].presented_ns == sync::to_ns(host_ms(5)));
  CHECK(reports[0].scheduled_ns == sync::to_ns(host_ms(6)));
  CHECK(reports[0].part == presentation_t::CONSTRAINT);
  impulses.step(host_ms(20), 1e-3, std::vector{felt(8, 1)});
  onsets.step(tick(20, 1, true), impulses, reports);
  REQUIRE(reports.size() == 2);
  CHECK(reports[1].presented_ns == sync::to_ns(host_ms(20)));
  onsets.step(tick(300, 1, true), impulses, reports);
  CHECK(reports.size() == 2);
}

TEST_CASE("A begin without force is reported once, by whether its surface was known") {
  const ContactImpulses impulses;
  for (const bool known : {true, false}) {
    PendingOnsets onsets;
    std::vector<presentation_t> reports;
    onsets.add(1, 7, host_ms(6), host_ms(8), reports);
    onsets.step(tick(8, 1, known), impulses, reports);
    onsets.step(tick(107, 1, known), impulses, reports);
    CHECK(reports.empty());
    onsets.step(tick(108, 1, known), impulses, reports);
    REQUIRE(reports.size() == 1);
    CHECK(reports[0].outcome == (known ? presentation_t::PRESENTED : presentation_t::DROPPED_LATE));
    CHECK(reports[0].presented_ns == (known ? sync::to_ns(host_ms(8)) : -1));
  }
}

TEST_CASE("A begin that is felt late, because the touch models are late, is presented for every delay of a minute") {
  for (const int delay_ms : {0, 1, 99, 101, 300, 1000, 5000, 60'000}) {
    ContactImpulses impulses;
    PendingOnsets onsets;
    std::vector<presentation_t> reports;
    onsets.add(1, 7, host_ms(6), host_ms(7), reports);
    const int felt_ms = 10 + delay_ms;
    for (int ms = 7; ms <= felt_ms && reports.empty(); ++ms) {
      impulses.step(host_ms(ms), 1e-3, ms == felt_ms ? std::vector{felt(7, 1)} : std::vector<ContactForce>{});
      onsets.step(tick(ms, 1 + delay_ms, ms >= 8 + delay_ms, delay_ms), impulses, reports);
    }
    REQUIRE(reports.size() == 1);
    CHECK(reports[0].outcome == presentation_t::PRESENTED);
    CHECK(reports[0].presented_ns == sync::to_ns(host_ms(felt_ms)));
  }
}

TEST_CASE("A begin waits for a thinned touch model, but not longer than its settlement") {
  for (const int period_ms : {33, 200, 450, 2000}) {
    ContactImpulses impulses;
    PendingOnsets onsets;
    std::vector<presentation_t> reports;
    onsets.add(1, 7, host_ms(6), host_ms(7), reports);
    for (int ms = 7; ms < 3000 && reports.empty(); ++ms) {
      const int age = ms % period_ms;  // a model at each multiple of the period
      const bool shows = ms - age > 6;
      impulses.step(host_ms(ms), 1e-3, shows ? std::vector{felt(7, 1)} : std::vector<ContactForce>{});
      onsets.step(tick(ms, age, shows), impulses, reports);
    }
    REQUIRE(reports.size() == 1);
    CHECK((reports[0].outcome == presentation_t::PRESENTED) == (period_ms < 600));
    if (period_ms < 600) CHECK(reports[0].presented_ns == sync::to_ns(host_ms(period_ms)));
  }
}

TEST_CASE("Begins beyond the queue capacity are reported at once, and none is lost") {
  const ContactImpulses impulses;
  PendingOnsets onsets;
  std::vector<presentation_t> reports;
  const int count = static_cast<int>(PendingOnsets::kMaxPending) + 400;
  for (int i = 0; i < count; ++i) onsets.add(i, i, host_ms(0), host_ms(0), reports);
  CHECK(reports.size() == 400);
  onsets.step(tick(1000, 1, false), impulses, reports);
  CHECK(reports.size() == static_cast<std::size_t>(count));
}
