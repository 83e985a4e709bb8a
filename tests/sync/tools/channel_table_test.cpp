// Tables of any channel, read back and compared with their messages.
#include "sync/tools/channel_table.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <sstream>
#include <tactus/asset_request_t.hpp>
#include <tactus/clock_map_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/degradation_t.hpp>
#include <tactus/degraded_t.hpp>
#include <tactus/device_state_t.hpp>
#include <tactus/frame_shown_t.hpp>
#include <tactus/game_state_t.hpp>
#include <tactus/log_info_t.hpp>
#include <tactus/media_clock_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/playout_t.hpp>
#include <tactus/presented_t.hpp>
#include <tactus/setting_change_t.hpp>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <tactus/sync_report_t.hpp>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_request_t.hpp>
#include <tactus/tag_values_t.hpp>
#include <tactus/thermal_device_t.hpp>
#include <tactus/thermal_state_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/world_state_t.hpp>

#include "lcmtypes/channels.h"
#include "sync/text/csv.h"
#include "sync/bus/decode.h"
#include "tests/lcmtypes/samples.h"
#include "tests/lcmtypes/schema.h"
#include "tests/source_dir.h"

using namespace tactus;
using namespace tactus::sync;
using namespace tactus::test;

namespace {

#define EVERY_CHANNELS_TYPE                                                                                       \
  world_state_t, contact_frame_t, contact_events_t, touch_model_t, tool_state_t, device_state_t, thermal_state_t, \
      thermal_device_t, presented_t, node_health_t, sync_report_t, clock_map_t, media_clock_t, frame_shown_t,     \
      degradation_t, degraded_t, playout_t, setting_change_t, sim_command_t, sim_reply_t, game_state_t,           \
      log_info_t, asset_request_t, tag_list_t, tag_request_t, tag_values_t

struct Log {
  LogOrigin origin;
  TableContext context{origin};
  Log() {
    origin.known = true;
    origin.info.live_from_ns = 5'000'000'000;
    origin.info.header.clock = 77;
  }
  LogEvent event(const std::string& channel, const std::vector<std::uint8_t>& bytes) const {
    return {0, 0, channel, bytes};
  }
};

std::vector<std::vector<std::string>> cells_of(const std::string& rows) {
  std::vector<std::vector<std::string>> all;
  std::istringstream text(rows);
  for (std::string line; std::getline(text, line);) all.push_back(csv_cells(line));
  return all;
}

const Schema& schema() {
  static const Schema s(source_dir() + "/lcmtypes");
  return s;
}

}  // namespace

TEMPLATE_TEST_CASE("Every number and text of a message has a row that parses to the same value", "",
                   EVERY_CHANNELS_TYPE) {
  Log log;
  Samples samples(21);
  const MessageType& type = *message_type(TestType::getTypeName());
  for (int i = 0; i < 20; ++i) {
    TestType m{};
    samples.fill(m);
    m.header.sim_time_ns = i % 2 ? 1'500'000'000 : -1;
    m.header.seq = i;
    const auto bytes = encode(m);
    const auto rows = cells_of(long_rows(log.context, type, log.event("X", bytes), host_time(7'250'000'000)));
    std::size_t at = 0;
    for (const Spot& spot : schema().walk(TestType::getTypeName(), bytes)) {
      if (spot.path.starts_with("header.")) continue;
      INFO(spot.path);
      REQUIRE(at < rows.size());
      const auto& row = rows[at++];
      REQUIRE(row.size() == 8);
      CHECK(row[7] == "1");
      CHECK(row[0] == "2.250000000");
      CHECK(row[1] == (i % 2 ? "1.500000000" : ""));
      CHECK(row[3] == std::to_string(i));
      CHECK(row[4] == spot.path);
      const FieldPath path(type, spot.path);
      CHECK(row[5] == path.unit());
      const auto value = path.read(bytes);
      REQUIRE(value);
      if (const auto* text = std::get_if<std::string>(&*value))
        CHECK(row[6] == *text);
      else if (spot.type == "double" || spot.type == "float")
        CHECK(std::stod(row[6]) == std::get<double>(*value));
      else
        CHECK(static_cast<double>(std::stoll(row[6])) == std::get<double>(*value));
    }
    CHECK(at == rows.size());
  }
}

TEMPLATE_TEST_CASE("A wide table has a column for each field outside lists, and rows of equal length",
                   "", EVERY_CHANNELS_TYPE) {
  Log log;
  Samples samples(22);
  const MessageType& type = *message_type(TestType::getTypeName());
  const WideColumns columns(type);
  const auto names = cells_of(columns.names()).at(0);
  for (int i = 0; i < 5; ++i) {
    TestType m{};
    samples.fill(m);
    const auto bytes = encode(m);
    const auto rows = cells_of(columns.row(log.context, log.event("X", bytes), host_time(7'250'000'000)));
    REQUIRE(rows.size() == 1);
    REQUIRE(rows[0].size() == names.size());
    CHECK(names.back() == "run");
    CHECK(rows[0].back() == "1");
    for (std::size_t c = 4; c + 1 < names.size(); ++c) {
      const std::string path = names[c].substr(0, names[c].find(" ("));
      const FieldPath field(type, path);
      CHECK(names[c] == path + (field.unit().empty() ? "" : " (" + field.unit() + ")"));
      const auto value = field.read(bytes);
      REQUIRE(value);
      if (const auto* text = std::get_if<std::string>(&*value))
        CHECK(rows[0][c] == *text);
      else
        CHECK(std::stod(rows[0][c]) == std::get<double>(*value));
    }
  }
}

TEST_CASE("Text with commas, quotes and line ends stays in one cell, and damaged messages have no row") {
  CHECK(csv_cells(csv_cell(std::string_view("a,\"b\""))) == std::vector<std::string>{"a,\"b\""});
  CHECK(csv_cell(std::string_view("plain")) == "plain");
  CHECK(csv_cell(Leaf(0.1)) == "0.1");
  CHECK(csv_cell(Leaf(std::int64_t{-9'007'199'254'740'993})) == "-9007199254740993");  // no double represents it
  Log log;
  Samples samples(23);
  tool_state_t m{};
  samples.fill(m);
  auto bytes = encode(m);
  const MessageType& type = *message_type("tool_state_t");
  CHECK_FALSE(long_rows(log.context, type, log.event("X", bytes), {}).empty());
  bytes.pop_back();
  CHECK(long_rows(log.context, type, log.event("X", bytes), {}).empty());
  CHECK(WideColumns(type).row(log.context, log.event("X", bytes), {}).empty());
}

TEST_CASE("A message with a number that is not finite has no rows") {
  Log log;
  Samples samples(23);
  tool_state_t m{};
  samples.fill(m);
  const MessageType& type = *message_type("tool_state_t");
  CHECK_FALSE(long_rows(log.context, type, log.event("X", encode(m)), {}).empty());
  for (const double number : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    m.force_N.x = number;
    const auto bytes = encode(m);
    CHECK(long_rows(log.context, type, log.event("X", bytes), {}).empty());
    CHECK(WideColumns(type).row(log.context, log.event("X", bytes), {}).empty());
  }
}

TEST_CASE("Tagged values have their own time stamps, and senders have names") {
  Log log;
  tag_list_t list{};
  list.header.run_id = list.header.incarnation = 1, list.node = "haptic_node", list.list = 5,
  list.total = list.tag_count = 2;
  list.tags = {{"force", "N", 0}, {"speed", "m/s", 0}};
  node_health_t health{};
  health.header.run_id = health.header.incarnation = 1, health.header.source = 4242, health.node = "haptic_node";
  for (const auto& bytes : {encode(list), encode(health)})
    log.context.learn(log.event(bytes == encode(list) ? channels::kTagList : channels::kNodeHealth, bytes));
  CHECK(log.context.sender(4242) == "haptic_node");
  CHECK(log.context.sender(0x10) == "0x00000010");

  tag_values_t values{};
  values.header.run_id = values.header.incarnation = 1, values.header.publish_time_ns = 6'000'000'000;
  values.node = "haptic_node", values.list = 5, values.column_count = 2, values.columns = {0, 1};
  values.row_count = 2, values.times_ns = {5'100'000'000, 5'200'000'000};
  values.value_count = 4, values.values = {1, tag_values_t::NONE, 3, 0.25};
  for (const std::int32_t clock : {77, 78}) {
    values.header.clock = clock;
    TagTable tags = log.context.tags();
    const auto rows = cells_of(
        tag_rows(tags, log.context, log.event(channels::kTagValues, encode(values)), host_time(6'010'000'000)));
    REQUIRE(rows.size() == 3);
    // A message of another clock: its arrival has the same offset as its sending.
    CHECK(rows[0] ==
          std::vector<std::string>{clock == 77 ? "0.100000000" : "0.110000000", "haptic_node", "force", "N", "1", "1"});
    CHECK(rows[2] == std::vector<std::string>{clock == 77 ? "0.200000000" : "0.210000000", "haptic_node", "speed",
                                              "m/s", "0.25", "1"});
  }
}

TEST_CASE("A part of a log holds both of its ends, and tagged values by their own time") {
  CHECK(LogInterval{}.contains(INT64_MIN));
  const LogInterval part{.since_s = 0.15, .until_s = 0.2};
  CHECK_FALSE(part.contains(149'999'999));
  CHECK(part.contains(150'000'000));
  CHECK(part.contains(200'000'000));
  CHECK_FALSE(part.contains(200'000'001));

  Log log;
  tag_list_t list{};
  list.header.run_id = list.header.incarnation = 1, list.node = "haptic_node", list.list = 5, list.total = list.tag_count = 1;
  list.tags = {{"force", "N", 0}};
  log.context.learn(log.event(channels::kTagList, encode(list)));
  tag_values_t values{};
  values.header.run_id = values.header.incarnation = 1, values.header.clock = 77;
  values.node = "haptic_node", values.list = 5, values.column_count = 1, values.columns = {0};
  values.row_count = 2, values.times_ns = {5'100'000'000, 5'200'000'000};
  values.value_count = 2, values.values = {1, 3};
  TagTable tags = log.context.tags();
  const auto bytes = encode(values);
  // The message arrives after the interval; one of its values lies within it.
  const auto rows = cells_of(tag_rows(tags, log.context, log.event(channels::kTagValues, bytes), host_time(6'010'000'000), part));
  REQUIRE(rows.size() == 1);
  CHECK(rows[0][0] == "0.200000000");
}

TEST_CASE("A message of another system has a row with all its bytes") {
  Log log;
  const auto rows = cells_of(foreign_names() + foreign_row(TableContext(log.origin, 3), log.event("imu data", {0, 255, 16}), host_time(5'500'000'000)));
  CHECK(rows[0] == std::vector<std::string>{"log_s", "bytes", "data_hex", "run"});
  CHECK(rows[1] == std::vector<std::string>{"0.500000000", "3", "00ff10", "3"});
}

TEST_CASE("Each channel has a table of its own within the folder, for any name") {
  std::set<std::string> used = reserved_table_files();
  std::set<std::string> files;
  const std::vector<std::string> names{"a b",    "a_b",    "a/b",         "../../evil", ".hidden", "events", "tags", "TOOL STATE",
                                       "line\nbreak", "\xc3\x9c",   "=1+1", std::string(63, 'L'), "TOOL_STATE", "WORLD_STATE2"};
  for (const std::string& name : names) {
    const std::string file = table_file_of(name, used);
    INFO(file);
    CHECK(files.insert(file).second);
    CHECK(file.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._") == file.npos);
    CHECK(file[0] != '.');
  }
  CHECK(files.contains("TOOL_STATE.csv"));
  CHECK_FALSE(files.contains("events.csv"));
}
