// Tests of the runs, the times and the copies that a log holds.
#include "sync/log/log_index.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

#include "tests/sync/support/log_of_run.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

LogIndex index_of(const std::vector<std::uint8_t>& bytes) {
  LogIndex index(bytes);
  index.read_all();
  return index;
}

ReadRun read_bytes(const std::vector<std::uint8_t>& bytes, int number = 1) { return read_run(index_of(bytes), number); }

std::vector<std::vector<std::uint8_t>> data_of(const TestEvents& events) {
  std::vector<std::vector<std::uint8_t>> data;
  for (const TestEvent& e : events) data.push_back(e.data);
  return data;
}

}  // namespace

TEST_CASE("An ordinary log is one run, read as it was written, without a warning") {
  const TestEvents events = events_of({});
  const auto bytes = log_bytes(events);
  const LogIndex index = index_of(bytes);
  REQUIRE(index.runs().size() == 1);
  CHECK(index.warnings(1).empty());
  CHECK(index.run(1).run_id == 77);
  CHECK(index.run(1).origin.recovered.empty());
  const ReadRun read = read_run(index, 1);
  CHECK((read.data == data_of(events)));
  for (std::size_t i = 0; i < events.size(); ++i) REQUIRE(read.us[i] == events[i].stamp_us);
}

TEST_CASE("A jump of the recorder's clock, in either direction and of any size, changes neither duration nor times") {
  const TestEvents events = events_of({});
  std::mt19937_64 random(3);
  for (int round = 0; round < 60; ++round) {
    // From 0.15 s to 30 years.
    const double size_s = 0.15 * std::pow(10, static_cast<double>(random() % 9800) / 1000);
    const std::int64_t by_us = static_cast<std::int64_t>(size_s * 1e6) * (round % 2 ? 1 : -1);
    const std::size_t at = 200 + random() % (events.size() - 400);
    TestEvents jumped = events;
    for (std::size_t i = at; i < jumped.size(); ++i) jumped[i].stamp_us += by_us;
    const auto bytes = log_bytes(jumped);
    const LogIndex index = index_of(bytes);
    INFO("round " << round << ", " << by_us << " us at event " << at);
    REQUIRE(index.runs().size() == 1);
    CHECK(index.warnings(1).size() == 1);
    REQUIRE(index.run(1).jumps.size() == 1);
    CHECK(std::abs(index.run(1).jumps[0].by_us - by_us) <= 1000);
    const ReadRun read = read_run(index, 1);
    CHECK((read.data == data_of(events)));
    // Accurate to one latency.
    for (std::size_t i = 0; i < events.size(); ++i) REQUIRE(std::abs(read.us[i] - events[i].stamp_us) <= 1000);
    CHECK(std::is_sorted(read.us.begin(), read.us.end()));
  }
}

TEST_CASE("Several jumps of the recorder's clock are one warning") {
  TestEvents events = events_of({});
  const TestEvents original = events;
  for (std::size_t i = 1000; i < events.size(); ++i) events[i].stamp_us += 10'800'000'000;
  for (std::size_t i = 2000; i < events.size(); ++i) events[i].stamp_us -= 3'600'000'000;
  const auto bytes = log_bytes(events);
  const LogIndex index = index_of(bytes);
  CHECK(index.run(1).jumps.size() == 2);
  REQUIRE(index.warnings(1).size() == 1);
  CHECK_THAT(index.warnings(1)[0], Catch::Contains("jumped 2 times"));
  CHECK(index.run(1).length_s() == Approx(static_cast<double>(original.back().stamp_us - original.front().stamp_us) * 1e-6).margin(0.001));
}

TEST_CASE("A pause in which nothing was sent, or in which the recorder stood still, is no jump") {
  TestEvents events = events_of({});
  SECTION("nothing was sent for a second") {
    events.erase(events.begin() + 1200, events.begin() + 1800);
  }
  SECTION("the recorder stood still for 0.6 s and then stamped all waiting messages") {
    const std::int64_t end_us = events[1560].stamp_us;
    for (std::size_t i = 1200; i < 1560; ++i) events[i].stamp_us = end_us;
  }
  const auto bytes = log_bytes(events);
  const LogIndex index = index_of(bytes);
  CHECK(index.run(1).jumps.empty());
  CHECK(index.warnings(1).empty());
  const ReadRun read = read_run(index, 1);
  REQUIRE(read.data == data_of(events));
  for (std::size_t i = 0; i < events.size(); ++i) REQUIRE(read.us[i] == events[i].stamp_us);
}

TEST_CASE("Events that a loaded logger exchanged are read in the order of their times") {
  const TestEvents events = events_of({});
  TestEvents swapped = events;
  for (std::size_t i = 10; i + 1 < swapped.size(); i += 7) std::swap(swapped[i], swapped[i + 1]);
  const ReadRun read = read_bytes(log_bytes(swapped)), original = read_bytes(log_bytes(events));
  CHECK(read.us == original.us);
  // Events with one stamp have no order of their own.
  std::set<std::pair<std::int64_t, std::vector<std::uint8_t>>> one, other;
  for (std::size_t i = 0; i < read.us.size(); ++i) one.emplace(read.us[i], read.data[i]), other.emplace(original.us[i], original.data[i]);
  CHECK(one == other);
}

TEST_CASE("Two runs in one file are distinguished, with different identities and with the same") {
  const auto same_identity = GENERATE(false, true);
  TestRun second{.run_id = 78, .incarnation = 50, .scene = "two.sdf", .ticks = 700, .begin_ns = 9'000'000'000'000, .text = "other"};
  if (same_identity) {  // as virtual time gives them to all runs of one seed
    second = {.scene = "two.sdf", .ticks = 700, .text = "other"};
  }
  const TestEvents a = events_of({}), b = events_of(second);
  for (const bool swapped : {false, true}) {
    const auto bytes = log_bytes(swapped ? b + a : a + b);
    const LogIndex index = index_of(bytes);
    INFO("identities " << same_identity << ", order " << swapped);
    REQUIRE(index.runs().size() == 2);
    CHECK(index.runs()[swapped].origin.info.scene == "one.sdf");
    CHECK(index.runs()[!swapped].origin.info.scene == "two.sdf");
    CHECK((read_run(index, swapped ? 2 : 1).data == data_of(a)));
    CHECK((read_run(index, swapped ? 1 : 2).data == data_of(b)));
    for (const int run : {1, 2}) CHECK(index.run(run).jumps.empty());
    REQUIRE(index.warnings(1).size() == 1);
    CHECK_THAT(index.warnings(1)[0], Catch::Contains("2 runs") && Catch::Contains("one.sdf") && Catch::Contains("two.sdf"));
    CHECK_THROWS_WITH(index.run(3), Catch::Contains("holds 2 runs"));
  }
}

TEST_CASE("A LOG_INFO that names a run that never was hides no message, whether the run is short or another one precedes it") {
  const auto forged = [](int ticks, std::int64_t begin_ns, std::int64_t run_id) {
    TestEvents events = events_of({.run_id = run_id, .incarnation = run_id, .ticks = ticks, .begin_ns = begin_ns});
    events[0] = events_of({.run_id = run_id + 65536, .incarnation = run_id, .ticks = 0, .begin_ns = begin_ns})[0];
    return events;
  };
  const int ticks = GENERATE(5, 15, 100, 1000);
  const TestEvents second = forged(ticks, 9'000'000'000'000, 78), first = forged(1000, 5'000'000'000, 77);
  const auto alone = log_bytes(second), both = log_bytes(first + second);
  const LogIndex index = index_of(alone), two = index_of(both);
  INFO(ticks << " ticks");
  REQUIRE(index.runs().size() == 1);
  CHECK((read_run(index, 1).data == data_of(second)));
  CHECK(index.run(1).origin.info.header.run_id == 78);
  if (ticks < 15) return;  // too few messages for a run
  CHECK(index.run(1).run_id == 78);
  REQUIRE(two.runs().size() == 2);
  CHECK((read_run(two, 1).data == data_of(first)));
  CHECK((read_run(two, 2).data == data_of(second)));
  CHECK(two.run(1).run_id == 77);
  CHECK(two.run(2).run_id == 78);
}

TEST_CASE("A run that begins like another one and then differs is a run of its own") {
  const TestEvents a = events_of({});
  TestEvents b = a;
  TestRun changed;
  changed.text = "other";
  const TestEvents other = events_of(changed);
  for (std::size_t i = b.size() / 2; i < b.size(); ++i) b[i] = other[i];
  const auto bytes = log_bytes(a + b);
  const LogIndex index = index_of(bytes);
  REQUIRE(index.runs().size() == 2);
  CHECK((read_run(index, 1).data == data_of(a)));
  CHECK((read_run(index, 2).data == data_of(b)));
}

TEST_CASE("A run that is replayed without a change while another one is recorded is part of it") {
  TestEvents events = events_of({});
  const TestEvents old = events_of({.run_id = 12, .incarnation = 900, .ticks = 300, .begin_ns = 1'000'000'000});
  // Twice, one replay behind the other.
  for (int pass = 0; pass < 2; ++pass)
    for (std::size_t i = 1; i < old.size(); ++i)
      events.push_back({events[300].stamp_us + pass * 2'000'000 + (old[i].stamp_us - old[1].stamp_us), old[i].channel, old[i].data});
  std::stable_sort(events.begin(), events.end(), [](const auto& x, const auto& y) { return x.stamp_us < y.stamp_us; });
  const auto bytes = log_bytes(events);
  const LogIndex index = index_of(bytes);
  REQUIRE(index.runs().size() == 1);
  CHECK(index.run(1).run_id == 77);
  CHECK(index.run(1).guests == std::set<std::int64_t>{12});
  CHECK((read_run(index, 1).data == data_of(events)));  // in parentheses, because Catch prints megabytes otherwise
  CHECK(index.run(1).jumps.empty());
}

TEST_CASE("Copies of messages are left out, however two logs were merged") {
  const TestEvents events = events_of({});
  TestEvents merged;
  std::mt19937 random(8);
  SECTION("each event twice") {
    for (const TestEvent& e : events) merged.push_back(e), merged.push_back(e);
  }
  SECTION("one log behind the other") { merged = events + events; }
  SECTION("sorted by stamps, with clocks 3 s apart and losses in one") {
    TestEvents late = events;
    for (TestEvent& e : late) e.stamp_us += 3'000'000;
    for (std::size_t i = 1; i < events.size(); ++i) {
      merged.push_back(events[i]);
      if (random() % 10 != 0) merged.push_back(late[i]);
    }
    merged.push_back(events[0]);
    std::stable_sort(merged.begin(), merged.end(), [](const auto& x, const auto& y) { return x.stamp_us < y.stamp_us; });
  }
  const auto bytes = log_bytes(merged);
  const LogIndex index = index_of(bytes);
  REQUIRE(index.runs().size() == 1);
  const ReadRun read = read_run(index, 1);
  CHECK((read.data == data_of(events)));
  for (std::size_t i = 0; i < events.size(); ++i) REQUIRE(read.us[i] == events[i].stamp_us);
  REQUIRE(index.warnings(1).size() == 1);
  CHECK_THAT(index.warnings(1)[0], Catch::Contains("copies"));
}

TEST_CASE("Messages of other systems are read once where two loggers wrote them, and stay where one logger wrote them") {
  const std::vector<std::uint8_t> same{1, 2, 3};
  TestEvents events;
  std::int64_t number = 0;
  for (const TestEvent& e : events_of({})) {
    events.push_back(e);
    if (++number % 20 == 0) events.push_back({e.stamp_us, "ROBOT", same});  // a state that does not change
  }
  TestEvents merged;
  for (const TestEvent& e : events) merged.push_back(e), merged.push_back(e);
  CHECK(read_bytes(log_bytes(events)).data == data_of(events));
  CHECK(read_bytes(log_bytes(merged)).data == data_of(events));
}

TEST_CASE("A damaged second copy is neither another run nor a reason to lose the first one") {
  std::mt19937 random(4);
  TestEvents merged;
  const TestEvents events = events_of({});
  for (const TestEvent& e : events) {
    merged.push_back(e);
    merged.push_back(e);
    if (random() % 10 == 0) merged.back().data.back() ^= 1;
  }
  const auto bytes = log_bytes(merged);
  const LogIndex index = index_of(bytes);
  REQUIRE(index.runs().size() == 1);
  std::multiset<std::vector<std::uint8_t>> read;
  for (const auto& data : read_run(index, 1).data) read.insert(data);
  for (const TestEvent& e : events) REQUIRE(read.contains(e.data));
}

TEST_CASE("A log without messages of this system continues after a step back without a gap") {
  TestEvents events;
  for (int i = 0; i < 1000; ++i) events.push_back({1'000'000'000 + 10'000 * i - (i >= 600 ? 3'600'000'000 : 0), "POSE", std::vector<std::uint8_t>(20, static_cast<std::uint8_t>(i))});
  const auto bytes = log_bytes(events);
  const LogIndex index = index_of(bytes);
  CHECK(index.run(1).length_s() == Approx(9.98));
  CHECK((read_run(index, 1).data == data_of(events)));
  CHECK_FALSE(index.run(1).origin.known);
}

TEST_CASE("Every channel name that LCM can send is an event") {
  TestEvents events = events_of({.ticks = 50});
  std::mt19937 random(6);
  for (int i = 0; i < 500; ++i) {
    std::string name(1 + random() % 63, ' ');
    for (char& c : name) c = static_cast<char>(1 + random() % 255);
    events.insert(events.begin() + static_cast<std::ptrdiff_t>(1 + random() % (events.size() - 1)), {0, name, {1, 2, 3}});
  }
  for (std::size_t i = 1; i < events.size(); ++i)
    if (events[i].stamp_us == 0) events[i].stamp_us = events[i - 1].stamp_us;
  const auto bytes = log_bytes(events);
  const LogIndex index = index_of(bytes);
  CHECK(index.damaged_regions() == 0);
  const ReadRun read = read_run(index, 1);
  REQUIRE(read.channels.size() == events.size());
  for (std::size_t i = 0; i < events.size(); ++i) REQUIRE(read.channels[i] == events[i].channel);
}

TEST_CASE("The whole file is read in its own order, with copies, one run behind the other") {
  const TestEvents a = events_of({}), b = events_of({.scene = "two.sdf", .text = "other"});
  const auto bytes = log_bytes(a + a + b);
  const LogIndex index = index_of(bytes);
  const ReadRun read = read_run(index, TimestampedEvents::kWholeFile);
  CHECK(read.data == data_of(a + a + b));
  CHECK(std::is_sorted(read.us.begin(), read.us.end()));
  CHECK(read.us.back() - read.us.front() <= 2 * (a.back().stamp_us - a.front().stamp_us));
}

TEST_CASE("Reading from any time gives the same events as reading to it") {
  TestEvents events = events_of({});
  for (std::size_t i = 10; i + 1 < events.size(); i += 7) std::swap(events[i], events[i + 1]);
  for (std::size_t i = 1500; i < events.size(); ++i) events[i].stamp_us -= 3'600'000'000;
  const auto bytes = log_bytes(events);
  const LogIndex index = index_of(bytes);
  const ReadRun all = read_run(index, 1);
  std::mt19937 random(5);
  for (int round = 0; round < 100; ++round) {
    const std::size_t from = random() % all.us.size();
    TimestampedEvents part(index, 1);
    part.seek(index.run(1).origin.time(all.us[from]));
    std::vector<std::vector<std::uint8_t>> data;
    HostTime at{};
    for (LogEvent e; part.next(e, at);) data.emplace_back(e.data.begin(), e.data.end());
    REQUIRE(data.size() >= all.data.size() - from);
    REQUIRE(data.size() <= all.data.size() - from + 400);  // LogIndex::kSeekInterval_us
    REQUIRE(std::equal(data.rbegin(), data.rend(), all.data.rbegin()));
  }
}

TEST_CASE("A log with random stamps is read to its end, each event once") {
  std::mt19937_64 random(7);
  TestEvents events = events_of({.ticks = 3000});
  for (TestEvent& e : events) e.stamp_us = static_cast<std::int64_t>(random() >> 2);
  CHECK(read_bytes(log_bytes(events)).data.size() == events.size());
}
