// Tests of the variables that a page plots: decimation, bounds and hostile bytes.
#include "scripts/live/watches.h"

#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <tactus/tool_state_t.hpp>

#include "lcmtypes/channels.h"
#include "tests/live/live_time.h"
#include "tests/sync/support/memory_sink.h"

using namespace tactus;
using namespace tactus::live;
using tactus::test::at;

namespace {

std::vector<std::uint8_t> tool(const std::string& node, double force_N) {
  tool_state_t m{};
  m.header = sync::header_of(node, 1, 0, 1);
  m.force_N.z = static_cast<float>(force_N);
  return sync::encode(m);
}

struct WatchesFixture {
  Watches watches;
  WatchesFixture() { REQUIRE(watches.set({"TOOL_STATE:force_N.z", "sim_node.work.collision"}).empty()); }
  void tool_at(double s, double force_N, const std::string& node = "haptic_node") {
    watches.on_message(channels::kToolState, tool(node, force_N), at(s));
  }
};

}  // namespace

TEST_CASE("A page receives each value of its watched variables once, and no others") {
  WatchesFixture w;
  CHECK(w.watches.accepts(channels::kToolState));
  CHECK_FALSE(w.watches.accepts(channels::kWorldState));
  CHECK(w.watches.tags() == std::vector<std::string>{"sim_node.work.collision"});
  w.tool_at(0, 1.5);
  w.watches.on_tag_value("sim_node.work.collision", at(0.25), 7);
  w.watches.on_tag_value("sim_node.work.solve", at(0.25), 8);
  const auto source = static_cast<std::int32_t>(sync::fnv1a_32("haptic_node"));
  CHECK(w.watches.values() == nlohmann::json({{0, 10.0, 1.5, source}, {1, 10.25, 7.0, 0}}));
  CHECK(w.watches.values().empty());
}

TEST_CASE("Two hands that publish one variable are two curves") {
  WatchesFixture w;
  for (int i = 0; i < 10; ++i) {
    w.tool_at(0.01 * i, 1, "haptic_node");
    w.tool_at(0.01 * i + 0.001, 2, "haptic_node_left");
  }
  std::map<std::int64_t, std::set<double>> values;
  const auto all = w.watches.values();
  CHECK(all.size() == 20);  // the senders are decimated separately
  for (const auto& v : all) values[v[3].get<std::int64_t>()].insert(v[2].get<double>());
  CHECK(values.size() == 2);
  for (const auto& [source, of] : values) CHECK(of.size() == 1);

  SECTION("senders beyond the maximum are dropped") {
    for (int i = 0; i < 100; ++i) w.tool_at(1, i, "node_" + std::to_string(i));
    CHECK(w.watches.values().size() == Watches::kMaxSenders - 2);
  }
}

TEST_CASE("Values are decimated to 200 a second, and a full queue drops the oldest") {
  WatchesFixture w;
  for (int i = 0; i < 1000; ++i) w.tool_at(0.001 * i, i);
  CHECK(w.watches.values().size() == 200);
  for (int i = 0; i < 100'000; ++i) w.tool_at(2 + 0.005 * i, i);
  const auto all = w.watches.values();
  REQUIRE(all.size() == Watches::kMaxWaiting);
  CHECK(all.back()[2] == 99'999);  // after a jump in a log, the newest values before its place remain
}

TEST_CASE("Values of a log are shown after a seek backwards, and non-finite values are not") {
  WatchesFixture w;
  w.tool_at(5, 1);
  w.tool_at(1, 2);
  CHECK(w.watches.values().size() == 2);
  w.watches.on_tag_value("sim_node.work.collision", at(1), NAN);
  w.watches.on_tag_value("sim_node.work.collision", at(2), INFINITY);
  CHECK(w.watches.values().empty());
}

TEST_CASE("Malformed messages of a channel give no value") {
  WatchesFixture w;
  const auto good = tool("haptic_node", 1);
  w.watches.on_message(channels::kToolState, {}, at(0));
  for (std::size_t size = 0; size + 1 < good.size(); size += 7)
    w.watches.on_message(channels::kToolState, std::span(good).first(size), at(static_cast<double>(size)));
  for (const auto& v : w.watches.values()) CHECK(v[2].is_number());  // bytes after the field may be missing
  auto other = good;
  other[0] ^= 0xff;  // another fingerprint
  w.watches.on_message(channels::kToolState, other, at(1e4));
  CHECK(w.watches.values().empty());
}

TEST_CASE("An invalid name is reported with a reason, and the others keep their indices") {
  Watches w;
  CHECK_THAT(w.set({"NO_SUCH:thing", "TOOL_STATE:force_N.z"}), Catch::Contains("NO_SUCH"));
  w.on_message(channels::kToolState, tool("haptic_node", 3), at(0));
  const auto values = w.values();
  REQUIRE(values.size() == 1);
  CHECK(values[0][0] == 1);
  CHECK_FALSE(w.set({"TOOL_STATE:no_such_field"}).empty());
  CHECK_THAT(w.set({"NODE_HEALTH:status_text"}), Catch::Contains("is text"));
  CHECK(w.set({}).empty());
  CHECK(w.values().empty());
}
