// Tests of setting changes at run time: each is applied once and answered each time.
#include "sync/node/setting_changes.h"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <tactus/setting_change_t.hpp>
#include <tactus/setting_reply_t.hpp>

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
  const auto apply = [&](const std::string& name, const std::string& value) {
    CHECK(name == "gain");
    CHECK(value == "1");
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
               [](const auto&, const auto&) { throw std::invalid_argument("many is not a number"); });
  const auto replies = changes.replies();
  REQUIRE(replies.size() == 1);
  CHECK(replies[0].done == 0);
  CHECK(replies[0].text == "haptic_node: many is not a number");
}

TEST_CASE("Changes for other nodes and other runs are ignored") {
  sync::SettingChanges changes("haptic_node", 7);
  const auto never = [](const auto&, const auto&) { FAIL("carried out"); };
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
  const auto apply = [&](const auto&, const auto&) { ++done; };
  for (int id = 1; id <= 1000; ++id) changes.process(change(id), apply);
  changes.process(change(1000), apply);  // remembered
  CHECK(done == 1000);
  changes.process(change(1), apply);  // forgotten long ago: by then no program repeats it
  CHECK(done == 1001);
}
