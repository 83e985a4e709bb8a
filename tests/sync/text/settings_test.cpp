// Tests of settings: units, ranges and precedence.
#include "sync/text/settings.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <sstream>

using namespace tactus::sync;

namespace {

struct Example {
  double delay_s = 0.02;
  int voices = 8;
  bool loud = false;
  std::string mode = "fast";
  std::string label;
  double hottest_degC = 42, coldest_degC = 15;
};
const std::vector<SettingField<Example>> kTable{
    {{"delay", "s", "0.02", 0, 1, "Delay", "design", "", true}, &Example::delay_s},
    {{"voices", "count", "8", 1, 64, "Voices", "design"}, &Example::voices},
    {{"loud", "bool", "false", 0, 0, "Loud", "design"}, &Example::loud},
    {{"mode", "fast|slow", "fast", 0, 0, "Mode", "design"}, &Example::mode},
    {{"note", "text", "", 0, 0, "Note", "design"}, &Example::label},
    {{"hottest", "degC", "42", 34, 43, "Hottest", "design", "max", true}, &Example::hottest_degC},
    {{"coldest", "degC", "15", 10, 30, "Coldest", "design", "min", true}, &Example::coldest_degC}};

struct Entry {
  std::string node, name, value;
};

}  // namespace

TEST_CASE("A choice with an open end accepts any word after its prefix, and no other") {
  const SettingRow row{"detector", "auto|gaps|custom:*", "auto", 0, 0, "Detector", "design"};
  for (const char* word : {"auto", "gaps", "custom:balls", "custom:b"}) CHECK_NOTHROW(check_setting(row, word));
  for (const char* word : {"", "cus", "custom", "custom:", "custom*", "balls", "gaps:x", "Custom:balls"}) CHECK_THROWS_AS(check_setting(row, word), std::invalid_argument);
}

TEST_CASE("A quantity may have any common unit of its kind") {
  CHECK(parse_quantity("20ms", "s") == Approx(0.02));
  CHECK(parse_quantity(" 20 ms ", "s") == Approx(0.02));
  CHECK(parse_quantity("1.5 kHz", "Hz") == 1500);
  CHECK(parse_quantity("180deg", "rad") == Approx(M_PI));
  CHECK(parse_quantity("2 N/mm", "N/m") == 2000);
  CHECK(parse_quantity("-3e-2", "m") == Approx(-0.03));
  CHECK(parse_quantity("5 %", "1") == Approx(0.05));
  CHECK(parse_quantity("5 m", "m") == 5);
}

TEST_CASE("An invalid quantity is rejected") {
  for (const char* text :
       {"", " ", "ms", "fast", "1.2.3", "20 Hz", "0x10", "1e999", "nan", "inf", "-inf", "5e", "1,5", "--1"}) {
    INFO(text);
    CHECK_THROWS_AS(parse_quantity(text, "s"), std::invalid_argument);
  }
}

TEST_CASE("Numbers are unchanged after writing and parsing") {
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000; ++i) {
    const double x =
        std::ldexp(static_cast<double>(random() % 2000000) - 1e6, static_cast<int>(random() % 60) - 40);
    std::ostringstream text;
    text.precision(17);
    text << x;
    REQUIRE(parse_quantity(text.str(), "N") == x);
  }
}

TEST_CASE("Settings are set by name") {
  Example e;
  const auto set_to = [&](const char* name, const char* value) { set<Example>(e, kTable, name, value); };
  set_to("delay", "35 ms");
  set_to("voices", "12");
  set_to("loud", "true");
  set_to("mode", "slow");
  set_to("note", "anything = goes");
  CHECK(e.delay_s == Approx(0.035));
  CHECK(e.voices == 12);
  CHECK(e.loud);
  CHECK(e.mode == "slow");
  CHECK(e.label == "anything = goes");
}

TEST_CASE("The error for an invalid value names setting, value and range") {
  Example e;
  const auto refusal = [&](const char* name, const char* value) {
    try {
      set<Example>(e, kTable, name, value);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const auto& [name, value, part] :
       std::vector<std::array<const char*, 3>>{{"delay", "2", "and 1 s"},
                                               {"delay", "-1ms", "between"},
                                               {"delay", "soon", "not a number"},
                                               {"voices", "2.5", "whole"},
                                               {"voices", "0", "between 1"},
                                               {"loud", "maybe", "true or false"},
                                               {"mode", "medium", "fast|slow"},
                                               {"mode", "fast|slow", "fast|slow"},
                                               {"mode", "", "fast|slow"},
                                               {"colour", "red", "no setting"}}) {
    INFO(name << " = " << value);
    const std::string message = refusal(name, value);
    CHECK(message.find(name) != std::string::npos);
    CHECK(message.find(part) != std::string::npos);
  }
  CHECK(e.delay_s == 0.02);
  CHECK(e.voices == 8);
  CHECK(e.mode == "fast");
}

TEST_CASE("The command line overrides the scene, entries of other nodes and invalid entries are ignored") {
  Example e;
  const std::vector<Entry> scene{
      {"me", "delay", "50ms"}, {"other", "voices", "3"}, {"me", "voices", "900"}, {"me", "mode", "slow"}};
  const auto refused = apply_settings<Example>(e, kTable, "me", scene, {"delay=70ms", "loud", "note=a=b"});
  CHECK(e.delay_s == Approx(0.07));
  CHECK(e.voices == 8);
  CHECK(e.mode == "slow");
  CHECK(e.label == "a=b");
  REQUIRE(refused.size() == 2);
  CHECK(refused[0].starts_with("me: setting \"voices\""));
  CHECK(refused[1].starts_with("me: setting \"loud\""));
}

TEST_CASE("A scene can tighten a safety limit, and only the command line can loosen it") {
  Example e;
  const auto apply = [&](const std::vector<Entry>& scene, const std::vector<std::string>& command_line) {
    return apply_settings<Example>(e, kTable, "me", scene, command_line);
  };
  SECTION("the scene tightens or keeps the limit") {
    CHECK(apply({{"me", "hottest", "40"}, {"me", "coldest", "20"}}, {}).empty());
    CHECK(e.hottest_degC == 40);
    CHECK(e.coldest_degC == 20);
    CHECK(apply({{"me", "hottest", "42"}, {"me", "coldest", "15"}}, {}).empty());
    CHECK(e.hottest_degC == 42);
    CHECK(e.coldest_degC == 15);
  }
  SECTION("a scene that loosens the limit is rejected with a remedy, also after it tightened it") {
    const auto refused = apply({{"me", "hottest", "40"}, {"me", "hottest", "42.5"}, {"me", "coldest", "14"}}, {});
    CHECK(e.hottest_degC == 40);
    CHECK(e.coldest_degC == 15);
    REQUIRE(refused.size() == 2);
    CHECK(refused[0] ==
          "me: setting \"hottest\" = \"42.5\": a scene or `tactus set` may only tighten this safety limit, to 42 degC or less; "
          "loosen it with "
          "--set on the node's own command line");
    CHECK(refused[1].find("to 15 degC or more") != std::string::npos);
  }
  SECTION("the command line loosens the limit within its range") {
    CHECK(apply({{"me", "hottest", "43"}}, {"hottest=42.5", "coldest=12"}).size() == 1);
    CHECK(e.hottest_degC == 42.5);
    CHECK(e.coldest_degC == 12);
  }
}

TEST_CASE("Only live settings change while the node runs, and a rejected change has no effect") {
  const Example own;
  Example s;
  change_live(s, own, std::span(kTable), "delay", "50ms");
  CHECK(s.delay_s == Approx(0.05));
  CHECK_THROWS_WITH(change_live(s, own, std::span(kTable), "voices", "9"), Catch::Contains("delay, hottest, coldest"));
  CHECK_THROWS_AS(change_live(s, own, std::span(kTable), "delay", "2s"), std::invalid_argument);
  CHECK_THROWS_AS(change_live(s, own, std::span(kTable), "nothing", "1"), std::invalid_argument);
  CHECK((s.voices == 8 && s.delay_s == Approx(0.05)));
}

TEST_CASE("A live change loosens no safety limit beyond the default or the command line") {
  Example own;
  own.hottest_degC = 40;  // the command line tightened one limit
  own.coldest_degC = 12;  // and loosened the other
  Example s = own;
  CHECK_THROWS_WITH(change_live(s, own, std::span(kTable), "hottest", "41"), Catch::Contains("command line"));
  change_live(s, own, std::span(kTable), "hottest", "37");
  change_live(s, own, std::span(kTable), "hottest", "40");
  CHECK(s.hottest_degC == 40);
  CHECK_THROWS_AS(change_live(s, own, std::span(kTable), "coldest", "13"), std::invalid_argument);
  change_live(s, own, std::span(kTable), "coldest", "20");
  CHECK(s.coldest_degC == 20);
}

TEST_CASE("Several live settings change together or not at all") {
  const Example own;
  Example s = own;
  std::vector<std::string> effective;
  const auto apply = [&](const Example& e, const std::string& name) { effective.push_back(name + " " + std::to_string(e.delay_s)); };
  const auto unchanged = [&] {
    return s.delay_s == own.delay_s && s.hottest_degC == own.hottest_degC && s.coldest_degC == own.coldest_degC;
  };
  // A value out of range, a setting that cannot change, a looser safety limit, and an unknown name, at each position.
  for (const auto& [name, value] : SettingList{{"delay", "2s"}, {"voices", "9"}, {"hottest", "43"}, {"nothing", "1"}})
    for (std::size_t at = 0; at < 3; ++at) {
      SettingList changes{{"coldest", "20"}, {"hottest", "37"}};
      changes.insert(changes.begin() + static_cast<std::ptrdiff_t>(at), {name, value});
      CHECK_THROWS_AS(change_live_together(s, own, std::span(kTable), changes, apply), std::invalid_argument);
      CHECK(unchanged());
      CHECK(effective.empty());
    }
  // The renderer itself refuses the last one: the first gets its old value again.
  const auto refuse = [&](const Example& e, const std::string& name) {
    apply(e, name);
    if (name == "hottest") throw std::invalid_argument("no");
  };
  CHECK_THROWS_AS(change_live_together(s, own, std::span(kTable), {{"delay", "50ms"}, {"hottest", "37"}}, refuse), std::invalid_argument);
  CHECK(unchanged());
  CHECK(effective == std::vector<std::string>{"delay 0.050000", "hottest 0.050000", "delay 0.020000"});
  effective.clear();
  change_live_together(s, own, std::span(kTable), {{"delay", "50ms"}, {"hottest", "37"}}, apply);
  CHECK(s.delay_s == Approx(0.05));
  CHECK(s.hottest_degC == 37);
  CHECK(effective.size() == 2);
}
