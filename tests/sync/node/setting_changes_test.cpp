// Tests of setting changes at run time: each is applied once and answered each time.
#include "sync/node/setting_changes.h"

#include <catch2/catch.hpp>
#include <random>
#include <stdexcept>
#include <tactus/setting_change_t.hpp>
#include <tactus/setting_reply_t.hpp>

#include "lcmtypes/utf8.h"

using namespace tactus;

namespace {

setting_change_t change(std::int64_t id, const std::string& value = "1") {
  setting_change_t c{};
  c.header.run_id = 7;
  c.id = id;
  c.node = "haptic_node";
  c.name = "gain";
  c.value = value;
  return c;
}

}  // namespace

TEST_CASE("A repeated change of a setting is applied once and answered each time") {
  sync::SettingChanges changes("haptic_node", 7);
  int done = 0;
  const auto apply = [&](const sync::SettingList& settings) {
    CHECK(settings == sync::SettingList{{"gain", "1"}});
    ++done;
  };
  for (int i = 0; i < 5; ++i) changes.process(change(3), apply);
  CHECK(done == 1);
  const auto replies = changes.replies();
  REQUIRE(replies.size() == 5);
  for (const setting_reply_t& r : replies) {
    CHECK(r.id == 3);
    CHECK(r.done == 1);
    CHECK(r.text == "haptic_node: gain is 1");
  }
  CHECK(changes.replies().empty());
}

TEST_CASE("An invalid change is rejected with the reason") {
  sync::SettingChanges changes("haptic_node", 7);
  changes.process(change(4, "many"),
               [](const auto&) { throw std::invalid_argument("many is not a number"); });
  const auto replies = changes.replies();
  REQUIRE(replies.size() == 1);
  CHECK(replies[0].done == 0);
  CHECK(replies[0].text == "haptic_node: many is not a number");
}

TEST_CASE("Changes for other nodes and other runs are ignored") {
  sync::SettingChanges changes("haptic_node", 7);
  const auto never = [](const auto&) { FAIL("carried out"); };
  setting_change_t other = change(5);
  other.node = "audio_node";
  changes.process(other, never);
  other = change(6);
  other.header.run_id = 8;
  changes.process(other, never);
  CHECK(changes.replies().empty());
}

TEST_CASE("Only a bounded number of changes is remembered") {
  sync::SettingChanges changes("haptic_node", 7);
  int done = 0;
  const auto apply = [&](const auto&) { ++done; };
  for (int id = 1; id <= 1000; ++id) changes.process(change(id), apply);
  changes.process(change(1000), apply);  // remembered
  CHECK(done == 1000);
  changes.process(change(1), apply);  // forgotten long ago: by then no program repeats it
  CHECK(done == 1001);
}

TEST_CASE("Settings of any printable value keep their order and their values in one request") {
  std::mt19937 random(5);
  const std::string letters = ",:=0123456789 abcN;\"'$()";
  for (int trial = 0; trial < 2000; ++trial) {
    sync::SettingList settings;
    const std::size_t count = 1 + random() % 4;
    for (std::size_t i = 0; i < count; ++i) {
      std::string value(random() % 30, ' ');
      for (char& c : value) c = letters[random() % letters.size()];
      settings.emplace_back("name_" + std::to_string(random() % 100), value);
    }
    setting_change_t c = change(1);
    sync::pack_settings(c, settings);
    REQUIRE(sync::unpack_settings(c) == settings);
  }
}

TEST_CASE("A malformed or too long group of settings is refused, and nothing is changed") {
  sync::SettingChanges changes("haptic_node", 7);
  const auto never = [](const auto&) { FAIL("carried out"); };
  std::int64_t id = 10;
  for (const char* value : {"", "1:a", "1:a2:b", "9:a1:b", "1:a1:bc", "x", "-1:a1:b", "99999999999999999999:a1:b", "1a1b"}) {
    setting_change_t c = change(++id, value);
    c.name = "gain,rate";
    changes.process(c, never);
    CHECK(changes.replies().at(0).done == 0);
  }
  for (const char* name : {"", ",", "gain,", ",gain", "gain,,rate"}) {
    setting_change_t c = change(++id, "1:a1:b");
    c.name = name;
    changes.process(c, never);
    CHECK(changes.replies().at(0).done == 0);
  }
  setting_change_t c = change(1);
  CHECK_THROWS_AS(sync::pack_settings(c, {{"a,b", "1"}}), std::invalid_argument);
  CHECK_THROWS_AS(sync::pack_settings(c, {{std::string(40, 'a'), "1"}, {std::string(40, 'b'), "1"}}), std::invalid_argument);
  CHECK_THROWS_AS(sync::pack_settings(c, {{"a", std::string(150, '1')}, {"b", std::string(150, '1')}}), std::invalid_argument);
}

TEST_CASE("A long reply about a text of another language ends between two characters") {
  for (std::size_t shift = 0; shift < 3; ++shift) {
    sync::SettingChanges changes("haptic_node", 7);
    changes.process(change(4), [&](const auto&) {
      std::string text(shift, 'a');
      while (text.size() < 600) text += "\xe0\xa4\xa8";
      throw std::invalid_argument(text);
    });
    const auto replies = changes.replies();
    REQUIRE(replies.size() == 1);
    CHECK(replies[0].text.size() > 509);
    CHECK(replies[0].text.size() <= 512);
    CHECK(is_text_line(replies[0].text));
  }
}
