// Tests of the terminal screen of the spy and its keys.
#include "sync/tools/spy/screen.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <tactus/tag_list_t.hpp>
#include <tactus/tag_values_t.hpp>
#include <tactus/tool_state_t.hpp>

#include "sync/bus/decode.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using namespace tactus::sync::spy;
using tactus::test::at_ms;

namespace {

// Number of characters that a terminal counts.
std::size_t letters(const std::string& line) {
  return static_cast<std::size_t>(
      std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

struct Shown {
  ClockMaps maps{7};
  Channels channels{OwnClock{7, 1, &maps}};
  Screen screen;
  HostTime now = at_ms(1000);

  void receive(const std::string& channel, const std::vector<std::uint8_t>& bytes) {
    MessageBatch batch;
    REQUIRE(batch.add(now, {channel, bytes}, 1 << 20));
    channels.push(batch[0]);
  }
  void tool(double z) {
    tool_state_t m{};
    m.header.run_id = 7, m.header.clock = 1, m.header.incarnation = 9, m.header.source = 5, m.header.seq = seq++;
    m.header.publish_time_ns = to_ns(now);
    m.force_N.z = static_cast<float>(z);
    receive("TOOL_STATE", encode(m));
  }
  std::vector<std::string> draw(std::size_t columns = 120, std::size_t rows = 20) {
    return screen.draw(channels, now, columns, rows);
  }
  std::string all(std::size_t columns = 120, std::size_t rows = 60) {
    std::string text;
    for (const std::string& line : draw(columns, rows)) text += line + "\n";
    return text;
  }
  // Presses a key and draws the screen.
  void press(Key key) { screen.press(key), draw(120, 60); }
  std::int64_t seq = 0;
};

}  // namespace

TEST_CASE("Keys are parsed from terminal bytes, also if a sequence arrives in pieces") {
  std::string bytes = "j\x1b[A\x1b[Bkq\x1b[5~\x1bOA\r";
  CHECK(take_keys(bytes) == std::vector<Key>{Key::kDown, Key::kUp, Key::kDown, Key::kUp, Key::kQuit, Key::kPageUp,
                                             Key::kUp, Key::kEnter});
  CHECK(bytes.empty());
  bytes = "\x1b[";
  CHECK(take_keys(bytes).empty());
  bytes += "6";
  CHECK(take_keys(bytes).empty());
  bytes += "~x";
  CHECK(take_keys(bytes) == std::vector<Key>{Key::kPageDown});
  bytes = "\x1b[" + std::string(1000, '1');
  take_keys(bytes);
  CHECK(bytes.empty());
}

TEST_CASE("A sparkline is scaled from its lowest to its highest value and blank without data") {
  Spark spark(Nanoseconds(1'000'000));
  for (int i = 0; i < 8; ++i) spark.add(i, at_ms(i));
  CHECK(spark.draw(at_ms(7), 8).text == "▁▂▃▄▅▆▇█");
  CHECK(spark.draw(at_ms(7), 4).text == "▁▃▆█");
  CHECK(spark.draw(at_ms(7), 4).lowest == 4);
  CHECK(spark.draw(at_ms(9), 4).text == "▁█  ");
  CHECK(letters(spark.draw(at_ms(500), 30).text) == 30);
  spark.add(std::nan(""), at_ms(8));
  CHECK(spark.draw(at_ms(8), 2).text == "▁ ");
}

TEST_CASE("The screen fits any terminal size") {
  Shown s;
  for (int i = 0; i < 100; ++i) s.receive("A_RATHER_LONG_CHANNEL_NAME_" + std::to_string(i), {1, 2, 3});
  for (int i = 0; i < 20; ++i) s.now += Nanoseconds(100'000'000), s.tool(i);
  for (const Key page : {Key::kNone, Key::kEnter, Key::kTags}) {
    s.press(page);
    for (std::size_t columns = 40; columns <= 200; columns += 7)
      for (std::size_t rows = 5; rows <= 60; rows += 5) {
        const auto lines = s.draw(columns, rows);
        REQUIRE(lines.size() <= rows);
        for (const std::string& line : lines) REQUIRE(letters(line) <= columns);
        REQUIRE(s.screen.marked() < lines.size());
      }
  }
}

TEST_CASE("The cursor stays on its channel, and enter opens the fields of its newest message") {
  Shown s;
  s.receive("B", {1});
  s.tool(2.5);
  s.draw();
  s.press(Key::kDown);  // TOOL_STATE
  s.receive("A", {1});
  CHECK_THAT(s.draw()[s.screen.marked()], Catch::StartsWith("TOOL_STATE"));
  s.press(Key::kEnter);
  const std::string fields = s.all(160, 120);
  CHECK_THAT(fields, Catch::Contains("TOOL_STATE: the newest message"));
  CHECK_THAT(fields, Catch::Contains("force_N.z") && Catch::Contains("2.5"));
  s.press(Key::kBack);
  CHECK_THAT(s.draw()[s.screen.marked()], Catch::StartsWith("TOOL_STATE"));
  s.press(Key::kUp);
  s.press(Key::kEnter);
  CHECK_THAT(s.all(), Catch::Contains("no Tactus type"));
}

TEST_CASE("A sparkline of the selected field is drawn below it") {
  Shown s;
  s.tool(0);
  s.draw();
  s.press(Key::kEnter);
  for (int i = 0; i < 200 && s.draw(160, 120)[s.screen.marked()].rfind("force_N.z ", 0) != 0; ++i)
    s.screen.press(Key::kDown);
  REQUIRE_THAT(s.draw(160, 120)[s.screen.marked()], Catch::StartsWith("force_N.z "));
  for (int i = 0; i < 8; ++i) {
    s.now += Screen::kColumn;
    s.tool(i);
    s.screen.sample(s.channels, s.now);
  }
  CHECK_THAT(s.draw(160, 120)[s.screen.marked() + 1], Catch::Contains("▂▃▄▅▆▇█") && Catch::Contains("7"));
}

TEST_CASE("Variables are shown with value and unit, and requested only while they are shown") {
  Shown s;
  CHECK_FALSE(s.screen.shows_tags());
  s.press(Key::kTags);
  CHECK(s.screen.shows_tags());
  CHECK_THAT(s.all(), Catch::Contains("requested, none has arrived yet"));
  tag_list_t list{};
  list.header.incarnation = 3, list.node = "haptic_node", list.list = 5, list.total = list.tag_count = 1,
  list.tags = {{"force", "N", 0}};
  s.screen.push(list);
  tag_values_t values{};
  values.header.incarnation = 3, values.node = "haptic_node", values.list = 5,
  values.column_count = values.row_count = values.value_count = 1;
  values.columns = {0}, values.times_ns = {1}, values.values = {1.25};
  s.screen.push(values, s.now);
  CHECK_THAT(s.all(), Catch::Contains("haptic_node.force") && Catch::Contains("1.25 N"));
  s.press(Key::kTags);
  CHECK_FALSE(s.screen.shows_tags());
}

TEST_CASE("Control characters in channel names are escaped") {
  Shown s;
  s.receive("EVIL\x1b[2J", {1});
  for (const std::string& line : s.draw()) CHECK(line.find('\x1b') == std::string::npos);
}

TEST_CASE("Keys pause and quit the program") {
  Shown s;
  CHECK_FALSE(s.screen.over());
  s.press(Key::kPause);
  CHECK(s.screen.paused());
  CHECK_THAT(s.draw()[0], Catch::Contains("paused"));
  s.press(Key::kPause);
  CHECK_FALSE(s.screen.paused());
  s.press(Key::kQuit);
  CHECK(s.screen.over());
}
