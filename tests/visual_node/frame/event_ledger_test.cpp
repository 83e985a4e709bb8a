#include "visual_node/frame/event_ledger.h"

#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <tactus/contact_event_t.hpp>
#include <tactus/presentation_t.hpp>

#include "visual_node/frame/render_time.h"

using namespace tactus;
using namespace tactus::visual;
using std::chrono::milliseconds;

namespace {
contact_event_t event(std::int64_t id, int kind, std::int64_t time_ns) {
  contact_event_t e{};
  e.event_id = id;
  e.kind = static_cast<std::int8_t>(kind);
  e.time_ns = time_ns;
  return e;
}
}  // namespace

TEST_CASE("Every begin and hit has exactly one report under any frame timing") {
  const Settings settings;
  const sync::TimeMap map{sync::sim_time(0), sync::host_time(5'000'000'000), 1};
  std::mt19937 random(11);
  for (int trial = 0; trial < 50; ++trial) {
    EventLedger ledger(settings);
    std::map<std::int64_t, int> reports;
    std::map<std::int64_t, std::int64_t> expected_at;
    std::int64_t now = 5'000'000'000, id = 0;
    for (int frame = 0; frame < 100; ++frame) {
      // Occasional stalls of up to a second.
      now += random() % 20 == 0 ? static_cast<std::int64_t>(random() % 1'000'000'000) : 16'666'667;
      std::vector<contact_event_t> due;
      for (unsigned i = random() % 4; i > 0; --i) {
        const int kind = static_cast<int>(random() % 3);
        const std::int64_t time = now - 5'000'000'000 - static_cast<std::int64_t>(random() % 400'000'000);
        due.push_back(event(++id, kind, time));
        if (kind != contact_event_t::END) expected_at[id] = time + 5'000'000'000;
      }
      const std::size_t flashed = ledger.select_flashes(due, map, sync::host_time(now)).size();
      const auto presented = ledger.presented(sync::host_time(now + 3'000'000));
      std::size_t shown = 0;
      for (const presentation_t& r : presented) {
        ++reports[r.event_id];
        REQUIRE(expected_at.contains(r.event_id));
        CHECK(r.scheduled_ns == expected_at[r.event_id]);
        const std::int64_t late = now - r.scheduled_ns;
        if (r.outcome == presentation_t::DROPPED_LATE) {
          CHECK(late > 250'000'000);
          CHECK(r.presented_ns == -1);
        } else {
          ++shown;
          CHECK(late <= 250'000'000);
          CHECK(r.presented_ns == now + 3'000'000);
          CHECK((r.outcome == presentation_t::LATE) == (late + 3'000'000 > 50'000'000));
        }
      }
      CHECK(shown == flashed);
    }
    CHECK(reports.size() == expected_at.size());
    for (const auto& [event_id, count] : reports) CHECK(count == 1);
  }
}

TEST_CASE("The outcome of a late event follows the rule of the modality") {
  const sync::TimeMap map{sync::sim_time(0), sync::host_time(0), 1};
  const auto outcome = [&](sync::LateRule rule, std::int64_t late_ns, std::int64_t predicted_ns) {
    EventLedger ledger(Settings{}, rule);
    ledger.select_flashes({event(1, contact_event_t::HIT, 0)}, map, sync::host_time(predicted_ns));
    return ledger.presented(sync::host_time(late_ns)).at(0).outcome;
  };
  CHECK(outcome(sync::LateRule::kShowNewest, 50'000'000, 0) == presentation_t::PRESENTED);
  CHECK(outcome(sync::LateRule::kShowNewest, 50'000'001, 0) == presentation_t::LATE);
  CHECK(outcome(sync::LateRule::kShowNewest, 260'000'000, 250'000'001) == presentation_t::DROPPED_LATE);
  // Predicted to be in time, and shown: late by any amount.
  CHECK(outcome(sync::LateRule::kShowNewest, 900'000'000, 200'000'000) == presentation_t::LATE);
  CHECK(outcome(sync::LateRule::kAlwaysApply, 5'000'000'000, 5'000'000'000) == presentation_t::LATE);
}

TEST_CASE(
    "The drawing time is predicted by its median and ignores a single stall") {
  RenderTime time;
  for (int i = 0; i < 9; ++i) time.add(milliseconds(5));
  CHECK(time.expected() == milliseconds(5));
  time.add(milliseconds(2000));
  CHECK(time.expected() == milliseconds(5));
  for (int i = 0; i < 5; ++i) time.add(milliseconds(9));
  CHECK(time.expected() == milliseconds(9));
}
