// Tests of tagged variables: sampling, publishing and decoding at a receiver.
#include "sync/node/tags.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <tactus/tag_def_t.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_request_t.hpp>
#include <tactus/tag_values_t.hpp>

#include "lcmtypes/channels.h"
#include "lcmtypes/valid.h"
#include "sync/node/tag_table.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::at_ms;

namespace {

tag_request_t request(std::vector<std::string> patterns) {
  tag_request_t m{};
  m.header.run_id = 7, m.header.incarnation = 3;
  m.patterns = std::move(patterns), m.pattern_count = static_cast<std::int32_t>(m.patterns.size());
  return m;
}

struct Value {
  std::int64_t time_ns;
  double value;
};

// A node whose tag messages are received.
struct Heard {
  Tags tags{"node", 7};
  TagTable table;
  std::map<std::string, std::vector<Value>> values;  // by name and unit
  int lists = 0, messages = 0;
  std::size_t largest = 0;

  template <class Message>
  void check(Message& m) {
    m.header.run_id = 7, m.header.incarnation = 3, m.header.publish_time_ns = 1;
    REQUIRE(valid(m));
    largest = std::max(largest, static_cast<std::size_t>(m.getEncodedSize()));
  }
  void step(HostTime now) {
    tags.step(now);
    while (tag_list_t* m = tags.next_list()) check(*m), table.push(*m), ++lists;
    while (tag_values_t* m = tags.next_values()) {
      check(*m), ++messages;
      table.read(*m, [&](const TagTable::List& list, const tag_def_t& tag, std::int64_t t, double value) {
        values[list.node + "." + tag.name + " " + tag.unit].push_back({t, value});
      });
    }
  }
};

}  // namespace

TEST_CASE("Without a request no variable is read and nothing is sent") {
  Heard h;
  int read = 0;
  h.tags.add("x", "m", [&] { return ++read, 1.0; });
  for (int ms = 0; ms < 5000; ++ms) h.step(at_ms(ms));
  CHECK(read == 0);
  CHECK(h.lists + h.messages == 0);
  CHECK_FALSE(h.tags.requested());
}

TEST_CASE("A requested variable is read at every tick or at its rate, with unit and time") {
  Heard h;
  double x = 0;
  int n = 0;
  h.tags.add("x", "m", &x);
  h.tags.add("n", "1", &n, 10);
  h.tags.add("other", "N", [] { return 3.0; });
  h.tags.push(request({"node.x", "node.n"}), at_ms(0));
  for (int ms = 0; ms < 2000; ++ms) {
    x = 0.5 * ms, n = ms;
    h.step(at_ms(ms));
  }
  REQUIRE(h.values.size() == 2);
  const auto& xs = h.values.at("node.x m");
  REQUIRE(xs.size() >= 1950);  // values of the last 50 ms may still be queued
  for (std::size_t i = 0; i < xs.size(); ++i) {
    REQUIRE(xs[i].time_ns == static_cast<std::int64_t>(i) * 1'000'000);
    REQUIRE(xs[i].value == 0.5 * static_cast<double>(i));
  }
  const auto& ns = h.values.at("node.n 1");
  REQUIRE(ns.size() >= 19);
  for (std::size_t i = 0; i < ns.size(); ++i) REQUIRE(ns[i].value == 100.0 * static_cast<double>(i));
  CHECK(h.lists == 2);  // one list per second
  CHECK(h.table.unlisted() == 0);
}

TEST_CASE("A variable is sent until three seconds after the last request") {
  Heard h;
  double x = 1;
  h.tags.add("x", "m", &x);
  h.tags.push(request({"*"}), at_ms(0));
  for (int ms = 0; ms < 9000; ++ms) h.step(at_ms(ms));
  CHECK(h.values.at("node.x m").size() >= 2950);
  CHECK(h.values.at("node.x m").size() <= 3001);
  CHECK_FALSE(h.tags.requested());
}

TEST_CASE("With many tags each message fits a datagram and every value arrives") {
  Heard h;
  std::vector<double> variables(1024);
  for (std::size_t i = 0; i < variables.size(); ++i)
    h.tags.add("a_rather_long_name_of_a_variable_" + std::to_string(i), "kg m2/s2", &variables[i],
               i % 3 ? 0 : 250);
  h.tags.push(request({"*"}), at_ms(0));
  for (int ms = 0; ms < 300; ++ms) {
    for (std::size_t i = 0; i < variables.size(); ++i) variables[i] = static_cast<double>(i) + 1e-3 * ms;
    h.step(at_ms(ms));
  }
  CHECK(h.largest <= channels::kMaxMessageBytes);
  REQUIRE(h.values.size() == 1024);
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const auto& seen = h.values.at("node.a_rather_long_name_of_a_variable_" + std::to_string(i) + " kg m2/s2");
    REQUIRE(seen.size() >= (i % 3 ? 240 : 60));
    for (const Value& v : seen)
      REQUIRE(v.value == Approx(static_cast<double>(i) + 1e-9 * static_cast<double>(v.time_ns)));
  }
}

TEST_CASE("Values that are not finite are left out") {
  Heard h;
  double x = 0;
  h.tags.add("x", "m", &x);
  h.tags.push(request({"*"}), at_ms(0));
  const double none = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  for (int ms = 0; ms < 400; ++ms) {
    x = ms % 4 == 0 ? none : ms % 4 == 1 ? infinite : ms;
    h.step(at_ms(ms));
  }
  const auto& xs = h.values.at("node.x m");
  REQUIRE(xs.size() >= 170);
  for (const Value& v : xs) REQUIRE(std::isfinite(v.value));
}

TEST_CASE("A tag with a duplicate or invalid name, or without a unit, is rejected with one sentence") {
  Tags tags("node", 7);
  double x = 0;
  tags.add("x", "m", &x);
  CHECK_THROWS_WITH(tags.add("x", "N", &x), Catch::Contains("there is one of that name"));
  CHECK_THROWS_WITH(tags.add("", "N", &x), Catch::Contains("letters"));
  CHECK_THROWS_WITH(tags.add("a b", "N", &x), Catch::Contains("letters"));
  CHECK_THROWS_WITH(tags.add("y", "", &x), Catch::Contains("unit"));
  CHECK_THROWS_WITH(tags.add("y", "N", &x, -1), Catch::Contains("rate"));
  for (int i = 1; i < 1024; ++i) tags.add("x" + std::to_string(i), "m", &x);
  CHECK_THROWS_WITH(tags.add("y", "N", &x), Catch::Contains("1024"));
}

TEST_CASE("Values without a tag list are counted, and the number of stored lists is bounded") {
  Heard h;
  double x = 0;
  h.tags.add("x", "m", &x);
  h.tags.push(request({"*"}), at_ms(0));
  h.tags.step(at_ms(0));
  h.tags.step(at_ms(60));
  tag_values_t* values = h.tags.next_values();
  REQUIRE(values);
  values->header.incarnation = 3;
  TagTable table;
  int taken = 0;
  const auto take = [&](const auto&, const auto&, std::int64_t, double) { ++taken; };
  table.read(*values, take);
  CHECK(taken == 0);
  CHECK(table.unlisted() == 2);
  tag_list_t* list = h.tags.next_list();
  REQUIRE(list);
  for (int i = 0; i < 1000; ++i) {
    list->header.incarnation = 100 + i;
    table.push(*list);
  }
  CHECK(table.lists().size() == TagTable::kMaxLists);
  list->header.incarnation = 3;
  table.push(*list);
  table.read(*values, take);
  CHECK(taken == 2);
}
