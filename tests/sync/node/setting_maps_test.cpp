// Tests of tagged variables that drive settings.
#include "sync/node/setting_maps.h"

#include <catch2/catch.hpp>
#include <random>
#include <tactus/map_def_t.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_values_t.hpp>

#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::at_ms;

namespace {

map_def_t map(const std::string& from, const std::string& to, double gain = 1, double offset = 0,
              double low = -1e9, double high = 1e9) {
  map_def_t m{};
  m.tag = from, m.setting = to, m.gain = gain, m.offset = offset, m.low = low, m.high = high;
  return m;
}

// The tags "force" and "speed" of a process.
tag_list_t list(const std::string& node) {
  tag_list_t m{};
  m.header.incarnation = 3, m.node = node, m.list = 5, m.total = m.tag_count = 2;
  m.tags = {{"force", "N", 0}, {"speed", "m/s", 0}};
  return m;
}
tag_values_t values(std::int16_t column, std::vector<double> rows) {
  tag_values_t m{};
  m.header.incarnation = 3, m.node = "haptic_node", m.list = 5, m.column_count = 1, m.columns = {column};
  m.values = std::move(rows);
  m.row_count = m.value_count = static_cast<std::int32_t>(m.values.size());
  for (std::size_t i = 0; i < m.values.size(); ++i) m.times_ns.push_back(static_cast<std::int64_t>(i));
  return m;
}

}  // namespace

TEST_CASE("A mapped setting is offset plus gain times variable, clamped to its range") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-10, 10);
  for (int i = 0; i < 1000; ++i) {
    const double gain = any(random), offset = any(random), value = any(random);
    const map_def_t m = map("a.b", "c.d", gain, offset, -20, 30);
    CHECK(mapped(m, value) == std::min(30.0, std::max(-20.0, offset + gain * value)));
  }
}

TEST_CASE("Only maps to settings of this process are used, and each variable is requested once") {
  SettingMaps maps("visual_node");
  CHECK_FALSE(maps.any());
  maps.set({map("haptic_node.force", "visual_node.exposure"), map("haptic_node.force", "visual_node.display_gain"),
            map("haptic_node.speed", "audio_node.gain"), map("haptic_node.speed", "visual_node_left.exposure")});
  CHECK(maps.any());
  CHECK(maps.request().patterns == std::vector<std::string>{"haptic_node.force"});
  maps.set({});
  CHECK_FALSE(maps.any());
}

TEST_CASE("Only a changed variable changes the setting, at most 100 times a second") {
  SettingMaps maps("visual_node");
  maps.set({map("haptic_node.force", "visual_node.exposure", 0.5, 1)});
  maps.push(values(0, {8}));
  CHECK(maps.take_changes(at_ms(0)).empty());  // no tag list has defined that variable yet
  maps.push(list("haptic_node"));
  maps.push(values(1, {7}));  // the speed
  CHECK(maps.take_changes(at_ms(20)).empty());
  maps.push(values(0, {1, 2, 3}));
  auto changes = maps.take_changes(at_ms(40));
  REQUIRE(changes.size() == 1);
  CHECK(changes[0].name == "exposure");
  CHECK(changes[0].value == "2.5");
  CHECK(maps.take_changes(at_ms(60)).empty());
  maps.push(values(0, {3}));
  CHECK(maps.take_changes(at_ms(80)).empty());
  maps.push(values(0, {4}));
  CHECK(maps.take_changes(at_ms(81)).empty());  // too soon
  changes = maps.take_changes(at_ms(90));
  REQUIRE(changes.size() == 1);
  CHECK(changes[0].value == "3");
}

TEST_CASE("A process whose name is a prefix of another name does not drive its settings") {
  SettingMaps maps("visual_node");
  maps.set({map("haptic_node_lamp.force", "visual_node.exposure")});
  maps.push(list("haptic_node"));
  maps.push(values(0, {4}));
  CHECK(maps.take_changes(at_ms(0)).empty());
}

TEST_CASE("A map to a setting that cannot be changed is disabled") {
  SettingMaps maps("visual_node");
  maps.set({map("haptic_node.force", "visual_node.width")});
  maps.push(list("haptic_node"));
  maps.push(values(0, {4}));
  REQUIRE(maps.take_changes(at_ms(0)).size() == 1);
  maps.disable("width");
  CHECK_FALSE(maps.any());
}

TEST_CASE("Many maps request one pattern instead of more than a request holds") {
  SettingMaps maps("visual_node");
  std::vector<map_def_t> many;
  for (int i = 0; i < 100; ++i) many.push_back(map("haptic_node.a" + std::to_string(i), "visual_node.exposure"));
  maps.set(many);
  CHECK(maps.request().patterns == std::vector<std::string>{"*"});
}
