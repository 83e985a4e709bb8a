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
FeltForce felt(std::int64_t id, double newton) { return {id, 0, Vector3d::Zero(), {0, 0, newton}}; }
}  // namespace

TEST_CASE("A contact book sums force over time per contact, also the last share") {
  ContactImpulses book;
  std::vector<tool_constraint_t> told;
  for (int ms = 0; ms < 10; ++ms) book.step(host_ms(ms), 1e-3, std::vector{felt(7, 2)});
  book.tell(host_ms(9), told);
  REQUIRE(told.size() == 1);
  CHECK(told[0].impulse_N_s.z == Approx(9 * 2e-3));  // impulse so far
  CHECK(told[0].force_N.z == Approx(2));
  book.step(host_ms(10), 1e-3, {});
  book.tell(host_ms(10), told);
  REQUIRE(told.size() == 1);
  CHECK(told[0].impulse_N_s.z == Approx(10 * 2e-3));
  CHECK(told[0].force_N.z == 0);
  book.step(host_ms(70), 1e-3, {});
  book.tell(host_ms(70), told);
  CHECK(told.empty());
  book.step(host_ms(71), 1e-3, std::vector{felt(7, 2)});
  book.tell(host_ms(71), told);
  CHECK(told[0].impulse_N_s.z == Approx(10 * 2e-3));  // continues from its value
  CHECK(book.first_felt(7) == host_ms(71));
}

TEST_CASE("A contact book is bounded, and forgets what was felt longest ago") {
  ContactImpulses book;
  std::vector<tool_constraint_t> told;
  for (int i = 0; i < 1000; ++i) book.step(host_ms(i), 1e-3, std::vector{felt(i, 1)});
  CHECK_FALSE(book.first_felt(0));
  CHECK(book.first_felt(999) == host_ms(999));
  book.tell(host_ms(999), told);
  CHECK(told.size() == ContactImpulses::kMaxTold);
  CHECK(told[0].contact_id == 999);
}

TEST_CASE("A begin is presented when its force was first felt, before or after the event is known") {
  ContactImpulses book;
  PendingOnsets owed;
  std::vector<presentation_t> reports;
  book.step(host_ms(5), 1e-3, std::vector{felt(7, 1)});
  owed.add(1, 7, host_ms(6), host_ms(8), true, reports);
  owed.add(2, 8, host_ms(8), host_ms(8), true, reports);
  owed.step(host_ms(8), book, kUncertain, reports);
  REQUIRE(reports.size() == 1);
  CHECK(reports[0].event_id == 1);
  CHECK(reports[0].presented_ns == sync::to_ns(host_ms(5)));
  CHECK(reports[0].scheduled_ns == sync::to_ns(host_ms(6)));
  CHECK(reports[0].part == presentation_t::CONSTRAINT);
  book.step(host_ms(20), 1e-3, std::vector{felt(8, 1)});
  owed.step(host_ms(20), book, kUncertain, reports);
  REQUIRE(reports.size() == 2);
  CHECK(reports[1].presented_ns == sync::to_ns(host_ms(20)));
  owed.step(host_ms(300), book, kUncertain, reports);
  CHECK(reports.size() == 2);
}

TEST_CASE("A begin without force is reported once, by whether its surface was known") {
  const ContactImpulses book;
  PendingOnsets owed;
  std::vector<presentation_t> reports;
  owed.add(1, 7, host_ms(6), host_ms(8), true, reports);
  owed.add(2, 8, host_ms(6), host_ms(8), false, reports);
  owed.step(host_ms(107), book, kUncertain, reports);
  CHECK(reports.empty());
  owed.step(host_ms(108), book, kUncertain, reports);
  REQUIRE(reports.size() == 2);
  CHECK(reports[0].outcome == presentation_t::PRESENTED);
  CHECK(reports[0].presented_ns == sync::to_ns(host_ms(8)));
  CHECK(reports[1].outcome == presentation_t::DROPPED_LATE);
  CHECK(reports[1].presented_ns == -1);
}

TEST_CASE("More begins than can wait are reported at once, none is lost") {
  const ContactImpulses book;
  PendingOnsets owed;
  std::vector<presentation_t> reports;
  for (int i = 0; i < 500; ++i) owed.add(i, i, host_ms(0), host_ms(0), false, reports);
  owed.step(host_ms(1000), book, kUncertain, reports);
  CHECK(reports.size() == 500);
}
