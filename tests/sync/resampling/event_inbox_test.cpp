// Tests of the event inbox of a renderer. Repetitions, order and restarts are also tested with the contact stream.
#include "sync/resampling/event_inbox.h"

#include <catch2/catch.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <vector>

#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kMs;

namespace {

constexpr std::int64_t kStart = 1'000 * kMs;  // simulated time 0 on the host's clock

HostTime after_start(std::int64_t ms) { return host_time(kStart + ms * kMs); }

contact_event_t event(std::int64_t id, std::int8_t kind, std::int64_t ms) {
  contact_event_t e{};
  e.event_id = id;
  e.contact_id = 7;
  e.kind = kind;
  e.time_ns = ms * kMs;
  return e;
}

contact_events_t message(std::int64_t ms, std::vector<contact_event_t> list, std::int64_t incarnation = 1) {
  contact_events_t m{};
  m.header.run_id = 1;
  m.header.incarnation = incarnation;
  m.header.sim_time_ns = ms * kMs;
  m.header.publish_time_ns = kStart + ms * kMs;
  m.header.seq = ms;
  m.clock = {ms * kMs, kStart + ms * kMs, 1};
  m.events = std::move(list);
  m.count = static_cast<std::int32_t>(m.events.size());
  return m;
}

OperatorChain chain_of(const std::string& attributes) {
  return OperatorChain(parse_profile("<profile><degrade modality=\"audio\" " + attributes + "/></profile>", "p.xml"), "audio", {});
}

std::vector<std::int64_t> ids(const std::vector<contact_event_t>& events) {
  std::vector<std::int64_t> out;
  for (const contact_event_t& e : events) out.push_back(e.event_id);
  return out;
}

}  // namespace

TEST_CASE("An event that a profile delays is taken after its delay, and its contact is known from then on") {
  EventInbox inbox(1);
  OperatorChain chain = chain_of("delay=\"40ms network\"");
  inbox.push(message(10, {event(1, contact_event_t::BEGIN, 9)}), after_start(10), chain, nullptr);
  inbox.release(after_start(49));
  CHECK(inbox.take(SimTime::max()).empty());
  CHECK(inbox.span_of(7) == nullptr);
  inbox.release(after_start(50));
  CHECK(ids(inbox.take(SimTime::max())) == std::vector<std::int64_t>{1});
  REQUIRE(inbox.span_of(7));
  CHECK(inbox.span_of(7)->begin->event_id == 1);
}

TEST_CASE("The first arrival of an event is remembered, also of a dropped one") {
  EventInbox inbox(1);
  OperatorChain chain = chain_of("off=\"true\"");
  inbox.push(message(10, {event(1, contact_event_t::HIT, 9)}), after_start(10), chain, nullptr);
  inbox.push(message(20, {event(1, contact_event_t::HIT, 9)}), after_start(20), chain, nullptr);
  inbox.release(after_start(20));
  CHECK(inbox.take(SimTime::max()).empty());
  CHECK(ids(inbox.take_dropped()) == std::vector<std::int64_t>{1});
  CHECK(inbox.arrival_of(1) == after_start(10));
  CHECK_FALSE(inbox.arrival_of(2));
  std::vector<std::pair<std::int64_t, HostTime>> seen;
  inbox.each_newest_first([&](std::int64_t id, HostTime arrival) { return seen.emplace_back(id, arrival), true; });
  CHECK(seen == std::vector<std::pair<std::int64_t, HostTime>>{{1, after_start(10)}});
}

TEST_CASE("Events are taken before an instant, together or one by one, in order of time") {
  EventInbox inbox(1);
  inbox.push(message(10, {event(3, contact_event_t::HIT, 9), event(1, contact_event_t::HIT, 4), event(2, contact_event_t::HIT, 6)}), after_start(10));
  REQUIRE(inbox.front(sim_time(9 * kMs)));
  CHECK(inbox.front(sim_time(9 * kMs))->event_id == 1);
  inbox.pop_front();
  CHECK(inbox.front(sim_time(6 * kMs)) == nullptr);
  CHECK(ids(inbox.take(sim_time(9 * kMs))) == std::vector<std::int64_t>{2});
  CHECK(ids(inbox.take(SimTime::max())) == std::vector<std::int64_t>{3});
  inbox.pop_front();  // nothing is left
  CHECK(inbox.take(SimTime::max()).empty());
}

TEST_CASE("A restart discards pending and held events of the ended simulation") {
  EventInbox inbox(1);
  OperatorChain chain = chain_of("delay=\"40ms network\"");
  inbox.push(message(10, {event(1, contact_event_t::BEGIN, 9)}), after_start(10));
  CHECK(inbox.epoch() == 1);
  inbox.push(message(11, {event(2, contact_event_t::HIT, 11)}), after_start(11), chain, nullptr);
  inbox.release(after_start(11));
  inbox.push(message(20, {event(3, contact_event_t::HIT, 20)}, 2), after_start(90));
  CHECK(inbox.epoch() == 2);
  CHECK_FALSE(inbox.span_of(7)->begin);  // only the event of the new simulation is known
  inbox.release(after_start(100));
  CHECK(ids(inbox.take(SimTime::max())) == std::vector<std::int64_t>{3});
}

TEST_CASE("An event of an impossible future is refused, and accepted when its repetition is credible") {
  EventInbox inbox(1);
  inbox.push(message(10, {event(1, contact_event_t::HIT, 9)}), after_start(10));
  inbox.push(message(10, {event(2, contact_event_t::HIT, 3'600'000)}), after_start(10));
  CHECK(inbox.refused() == 1);
  inbox.push(message(11, {event(2, contact_event_t::HIT, 11)}), after_start(11));
  CHECK(ids(inbox.take(SimTime::max())) == std::vector<std::int64_t>{1, 2});
}

TEST_CASE("The operator duplicate presents an event once") {
  EventInbox inbox(1);
  OperatorChain chain = chain_of("duplicate=\"100%\"");
  inbox.push(message(10, {event(1, contact_event_t::HIT, 9)}), after_start(10), chain, nullptr);
  inbox.release(after_start(1000));
  CHECK(inbox.take(SimTime::max()).size() == 1);
  CHECK(inbox.duplicates() == 1);
}

TEST_CASE("Events that a profile holds are bounded, and the excess is counted") {
  EventInbox inbox(1);
  OperatorChain chain = chain_of("delay=\"40s network\"");
  std::vector<contact_event_t> list;
  constexpr std::int64_t kExcess = 10;
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(EventInbox::kMaxHeld) + kExcess; ++i) list.push_back(event(i + 1, contact_event_t::HIT, 9));
  inbox.push(message(10, list), after_start(10), chain, nullptr);
  CHECK(inbox.overflow() == kExcess);
}
