#include "sim_node/publish/page_scheduler.h"

#include <catch2/catch.hpp>
#include <deque>
#include <vector>

using namespace tactus;
using namespace tactus::sim;

namespace {

struct Run {
  std::vector<int> per_tick;
  std::vector<std::int64_t> world_taken, contacts_taken;
  std::size_t world_sent = 0, contacts_sent = 0;
  double world_rate = 0;
};

Run run(std::size_t world_pages, std::size_t contact_pages, int ticks, double budget = 2000) {
  PageScheduler s(60, budget, sync::Nanoseconds(1'000'000));
  Run r;
  for (int i = 0; i < ticks; ++i) {
    s.tick(sync::sim_time(i * std::int64_t{1'000'000}));
    if (s.due(Lane::kWorld)) s.begin(Lane::kWorld, world_pages), r.world_taken.push_back(i);
    if (s.due(Lane::kContacts)) s.begin(Lane::kContacts, contact_pages), r.contacts_taken.push_back(i);
    r.per_tick.push_back(0);
    for (Lane lane = s.next(); lane != Lane::kNone; lane = s.next()) {
      ++(lane == Lane::kWorld ? r.world_sent : r.contacts_sent);
      ++r.per_tick.back();
    }
  }
  r.world_rate = s.rate_Hz(Lane::kWorld);
  return r;
}

}  // namespace

TEST_CASE("Small states are sent completely at the ticks ceil(1000 n / 60)") {
  const Run r = run(1, 1, 3000);
  REQUIRE(r.world_taken.size() == 180);
  for (std::size_t n = 0; n < r.world_taken.size(); ++n)
    CHECK(r.world_taken[n] == static_cast<std::int64_t>((1000 * n + 59) / 60));
  CHECK(r.world_sent == 180);
  CHECK(r.contacts_sent == 180);
  for (const std::int64_t tick : r.world_taken) CHECK(r.per_tick[static_cast<std::size_t>(tick)] == 2);
}

TEST_CASE("Every second stays within its budget under any load, and no page is lost") {
  const std::size_t world = GENERATE(0u, 1u, 5u, 33u, 158u, 1000u);
  const std::size_t contacts = GENERATE(1u, 20u, 500u);
  const double budget = GENERATE(100.0, 2000.0);
  const Run r = run(world, contacts, 4000, budget);
  INFO("world " << world << " contacts " << contacts);
  int in_second = 0;
  for (std::size_t i = 0; i < r.per_tick.size(); ++i) {
    in_second += r.per_tick[i] - (i >= 1000 ? r.per_tick[i - 1000] : 0);
    REQUIRE_FALSE(in_second > budget + 1);
  }
  // Every snapshot was sent completely, except those in progress at the end.
  CHECK(r.world_sent + world >= r.world_taken.size() * world);
  CHECK(r.contacts_sent + contacts >= r.contacts_taken.size() * contacts);
  if (60.0 * static_cast<double>(world + contacts) > 1.2 * budget) {
    // The budget is used, except while only one lane has pages to send.
    CHECK(static_cast<double>(r.world_sent + r.contacts_sent) >= 0.9 * 4 * budget);
    // No lane starves the other: both get half of the budget, or all that they need.
    const double half = 2 * budget;
    CHECK(static_cast<double>(r.world_sent) >= std::min(half, 240.0 * static_cast<double>(world)) * 0.85 - 20);
    CHECK(static_cast<double>(r.contacts_sent) >= std::min(half, 240.0 * static_cast<double>(contacts)) * 0.85 - 20);
  }
}

TEST_CASE("The published rate is the actual rate") {
  CHECK(run(1, 1, 2000).world_rate == Approx(60).epsilon(0.05));
  // Half of 2,000 pages per second for 158 pages.
  CHECK(run(158, 1000, 4000).world_rate == Approx(1000.0 / 158).epsilon(0.05));
}

TEST_CASE("A new receiver gets the whole world within 100 ms under any load") {
  PageScheduler s(60, 2000, sync::Nanoseconds(1'000'000));
  std::size_t world = 0;
  int asked = -1, served = -1;
  for (int i = 0; i < 2000 && served < 0; ++i) {
    s.tick(sync::sim_time(i * std::int64_t{1'000'000}));
    if (s.due(Lane::kWorld)) s.begin(Lane::kWorld, 158);
    if (s.due(Lane::kContacts)) s.begin(Lane::kContacts, 500);
    if (i == 777) s.begin_urgent_world(158), asked = i, world = 0;
    for (Lane lane = s.next(); lane != Lane::kNone; lane = s.next())
      if (lane == Lane::kWorld && ++world == 158 && asked >= 0) served = i;
  }
  REQUIRE(served >= 0);
  CHECK(served - asked < 100);
}
