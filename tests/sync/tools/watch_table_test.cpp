// Tests of the status table of all nodes in the terminal and as JSON.
#include "sync/tools/watch_table.h"

#include <catch2/catch.hpp>
#include <sstream>
#include <tactus/node_health_t.hpp>
#include <tactus/sync_report_t.hpp>

using namespace tactus;
using namespace tactus::sync;

namespace {

const HostTime kNow = host_time(1'000'000'000'000);

node_health_t health(const std::string& node) {
  node_health_t m{};
  m.node = node;
  m.state = node_health_t::RUNNING;
  m.rate_Hz = 999.94;
  m.missed_ticks = 3;
  m.contacts_rendered = 17;
  m.status_text = "SCHED_FIFO 60, memory locked";
  m.inputs = {{"TOUCH_MODEL", 1'300'000, 0, 100, 0, 0}, {"CONTACT_EVENTS", 9'000'000'000, 0, 5, 0, 0},
              {"SCENE_MANIFEST", 700'000'000, 0, 5, 0, 0}};
  m.input_count = 3;
  return m;
}

}  // namespace

TEST_CASE("The table shows state, ticks and input age of a node") {
  WatchTable table;
  table.observe(health("haptic_node"), kNow);
  const auto rows = table.rows(kNow + Nanoseconds(100'000'000));
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].state == "running");
  CHECK(rows[0].missed_ticks == 3);
  CHECK(rows[0].rendered == 17);

  SECTION("the age is that of a continuous input and not of an event channel") {
    CHECK(rows[0].oldest_input == "TOUCH_MODEL");
    CHECK(rows[0].input_age == Nanoseconds(1'300'000));
  }
  SECTION("a silent node is lost and has no rate") {
    const auto later = table.rows(kNow + Nanoseconds(600'000'000));
    CHECK(later[0].state == "LOST");
    CHECK(later[0].rate_Hz == 0);
    CHECK(later[0].status_text == "silent for 600 ms");
  }
  SECTION("a node that publishes again is running") {
    table.observe(health("haptic_node"), kNow + Nanoseconds(2'000'000'000));
    CHECK(table.rows(kNow + Nanoseconds(2'000'000'000))[0].state == "running");
  }
}

TEST_CASE("The measured effect of a profile is a line below its node, and a member of the JSON") {
  node_health_t m = health("audio_node");
  m.status_text += "; profile effect: events +40.0 ms (sd 3.0)";
  WatchTable table;
  table.observe(m, kNow);
  CHECK(table.rows(kNow)[0].status_text == "SCHED_FIFO 60, memory locked");
  CHECK_THAT(table.to_text(kNow), Catch::Contains("\n  profile effect: events +40.0 ms (sd 3.0)\n"));
  CHECK_THAT(table.to_json(kNow), Catch::Contains("\"profile_effect\":\"events +40.0 ms (sd 3.0)\"") && Catch::Contains("memory locked\""));
  table.observe(health("audio_node"), kNow);
  CHECK_THAT(table.to_text(kNow), !Catch::Contains("profile effect"));
}

TEST_CASE("The table fits the width of the terminal") {
  WatchTable table;
  for (const char* name : {"audio_node", "haptic_node", "a_node_with_quite_a_long_name_indeed"})
    table.observe(health(name), kNow);
  sync_report_t report{};
  report.pages = 1;
  report.hits = 12;
  report.modalities = {{"audio", 12, 11, 1, 0, 0, 0, 0}};
  report.pairs = {{"haptic", "audio", 11, 1, -19'500'000, 3, 40'000, -1, -1}};
  table.observe(report);
  for (std::size_t width : {40u, 80u, 110u}) {
    std::istringstream lines(table.to_text(kNow, width));
    int n = 0;
    for (std::string line; std::getline(lines, line); ++n)
      if (n < 4) CHECK(line.size() <= width);
    CHECK(n == 5);
  }
  const std::string text = table.to_text(kNow);
  CHECK_THAT(text, Catch::Contains("999.9"));
  CHECK_THAT(text, Catch::Contains("1.3 ms TOUCH_MODEL"));
  CHECK_THAT(text, Catch::Contains("audio 11/12 LOST 1"));
  CHECK_THAT(text, Catch::Contains("haptic to audio -20 ms +-0.04 ms"));
}

TEST_CASE("Without a report the table contains a message") {
  CHECK_THAT(WatchTable().to_text(kNow), Catch::Contains("no node has reported yet"));
}

TEST_CASE("Control characters from a node are escaped") {
  WatchTable table;
  node_health_t m = health("a\x1b[2J");
  m.status_text = "one\ntwo\x1b]0;title\a";
  table.observe(m, kNow);
  const std::string text = table.to_text(kNow);
  CHECK(std::count(text.begin(), text.end(), '\n') == 2);
  CHECK(text.find_first_of("\x1b\a") == std::string::npos);
  CHECK_THAT(text, Catch::Contains("\\x1b[2J") && Catch::Contains("one\\x0atwo"));
}

TEST_CASE("The JSON output is one line for any note") {
  WatchTable table;
  node_health_t m = health("audio_node");
  m.status_text = "line\nbreak \"quoted\" \xff";
  table.observe(m, kNow);
  const std::string json = table.to_json(kNow);
  CHECK(std::count(json.begin(), json.end(), '\n') == 1);
  CHECK_THAT(json, Catch::Contains("\"missed_ticks\":3"));
}
