// Tests of the playout coordinator: demands, policies and requests.
#include "sync/playout/coordinator.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <tactus/playout_entry_t.hpp>
#include <tactus/playout_request_t.hpp>
#include <tactus/playout_t.hpp>

#include "lcmtypes/channels.h"
#include "sync/playout/exchange.h"
#include "sync/playout/lockstep.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kMillisecond;

namespace {

HostTime at(int ms) { return host_time(9'000'000'000) + ms * kMillisecond; }

PlayoutPlan plan(Policy policy = Policy::kLocalHapticFirst) {
  PlayoutPlan p;
  p.policy = policy;
  return p;
}

std::map<std::string, std::int64_t> delays_ms(const std::optional<playout_t>& m) {
  std::map<std::string, std::int64_t> out;
  if (m)
    for (const playout_entry_t& e : m->entries) out[e.modality] = e.delay_ns / kMillisecond.count();
  return out;
}

void heard(PlayoutCoordinator& c, const std::string& sense, int ms, int events = 40) {
  for (int i = 0; i < events; ++i) c.latency_demand().add(sense, ms * kMillisecond);
}

using Delays = std::map<std::string, std::int64_t>;

}  // namespace

TEST_CASE("A coordinator publishes the delay of each modality ten times a second") {
  PlayoutCoordinator c(5, plan());
  heard(c, "audio", 18), heard(c, "visual", 33), heard(c, "haptic", 2);
  int published = 0;
  for (int ms = 0; ms < 1000; ms += 5)
    if (const auto m = c.next_message(at(ms))) {
      ++published;
      CHECK(delays_ms(m) == Delays{{"audio", 33}, {"haptic", 0}, {"visual", 33}});
    }
  CHECK(published == 10);
}

TEST_CASE("Each modality keeps its own delay until the first presentation") {
  PlayoutCoordinator c(5, plan());
  c.latency_demand().add_modality("audio");
  CHECK(delays_ms(c.next_message(at(0))).empty());
  PlayoutCoordinator experiment(5, plan(Policy::kExperiment));
  experiment.latency_demand().add_modality("audio");
  CHECK(delays_ms(experiment.next_message(at(0))) == Delays{{"audio", 150}});
}

TEST_CASE("A stalled, slow or dead modality does not change the delays of the others") {
  PlayoutCoordinator c(5, plan());
  heard(c, "audio", 18), heard(c, "thermal", 25), heard(c, "visual", 33);
  const auto before = delays_ms(c.next_message(at(0)));
  SECTION("all waiting events are presented at once after a stall of 2 s") {
    for (int i = 0; i < 12; ++i) c.latency_demand().add("visual", (2000 - 80 * i) * kMillisecond);
    heard(c, "visual", 33, 8);
    CHECK(delays_ms(c.next_message(at(200))) == before);
  }
  SECTION("the modality stops reporting") {
    heard(c, "audio", 18, 500);
    CHECK(delays_ms(c.next_message(at(200))) == before);
  }
  SECTION("no modality waits for one that always exceeds the budget") {
    heard(c, "visual", 300, 200);
    const auto after = delays_ms(c.next_message(at(200)));
    CHECK(after.at("audio") == 25);
    CHECK(after.at("thermal") == 25);
  }
}

TEST_CASE("A delay rises at once and falls only by more than the slack") {
  PlayoutCoordinator c(5, plan());
  heard(c, "audio", 30, 200);
  CHECK(delays_ms(c.next_message(at(0))).at("audio") == 30);
  heard(c, "audio", 28, 200);
  CHECK(delays_ms(c.next_message(at(200))).at("audio") == 30);
  heard(c, "audio", 31, 200);
  CHECK(delays_ms(c.next_message(at(400))).at("audio") == 31);
  heard(c, "audio", 20, 200);
  CHECK(delays_ms(c.next_message(at(600))).at("audio") == 20);
}

TEST_CASE("A newer request is applied, an older one is rejected") {
  PlayoutCoordinator c(5, plan());
  PlayoutPlan requested = plan(Policy::kExperiment);
  requested.soa["visual"] = -50 * kMillisecond;
  CHECK(c.push(request_for(requested, 100)));
  heard(c, "audio", 18), heard(c, "visual", 33);
  const auto m = c.next_message(at(0));
  REQUIRE(m);
  CHECK(m->generation == 100);
  CHECK(delays_ms(m) == Delays{{"audio", 150}, {"visual", 100}});
  CHECK_FALSE(c.push(request_for(plan(Policy::kAsap), 99)));
  CHECK(c.plan().policy == Policy::kExperiment);
  requested.soa["visual"] = -500 * kMillisecond;  // before the event
  CHECK_FALSE(c.push(request_for(requested, 200)));
}

TEST_CASE("The coordinator with the lower clock id publishes, the other one is its backup") {
  PlayoutCoordinator low(3, plan()), high(7, plan());
  heard(low, "audio", 18), heard(high, "audio", 18);
  REQUIRE(low.push(request_for(plan(Policy::kExperiment), 50)));  // received by one modality only
  int high_said = 0;
  for (int ms = 0; ms < 2000; ms += 10) {
    if (auto m = low.next_message(at(ms))) {
      m->header.clock = 3;
      high.push(*m, at(ms));
    }
    if (auto m = high.next_message(at(ms))) {
      ++high_said;
      m->header.clock = 7;
      low.push(*m, at(ms));
    }
  }
  CHECK(high_said <= 1);
  CHECK(high.plan().policy == Policy::kExperiment);
  int alone = 0;
  for (int ms = 2000; ms < 4000; ms += 10) alone += high.next_message(at(ms)).has_value();
  CHECK(alone >= 9);
}

TEST_CASE("A request is stored for a restarted coordinator of the same run") {
  const auto folder = std::filesystem::temp_directory_path() / "tactus_playout_test";
  std::filesystem::create_directories(folder);
  auto request = request_for(plan(Policy::kItouch2005), 77);
  request.header.run_id = 12, request.header.source = 1, request.header.incarnation = 1;
  store_request(folder, request);
  REQUIRE(load_request(folder, 12));
  CHECK(load_request(folder, 12)->policy == playout_t::ITOUCH2005);
  CHECK_FALSE(load_request(folder, 13));
  std::ofstream(folder / "playout.request", std::ios::app) << "x";
  CHECK_FALSE(load_request(folder, 12));
  std::filesystem::remove_all(folder);
  CHECK_FALSE(load_request(folder, 12));
}

TEST_CASE("Lock-step times are aligned to simulated time for any host clock") {
  const TimeMap map{sim_time(123'456'789), at(0), 1.0};
  const Lockstep loop{map, 12.5};
  for (int ms = -500; ms < 500; ms += 7) {
    const HostTime t = at(ms);
    CHECK(loop.begin_of_iteration(t) <= t);
    CHECK(t - loop.begin_of_iteration(t) < 80 * kMillisecond);
    CHECK(loop.next_iteration(t) >= t);
    CHECK(loop.next_iteration(t) - t < 80 * kMillisecond);
    CHECK(map.to_sim(loop.next_iteration(t)).time_since_epoch() % (80 * kMillisecond) == Nanoseconds(0));
  }
}

TEST_CASE("Playout pages for any number of modalities fit the bus and hold all delays") {
  PlayoutCoordinator c(5, plan(Policy::kExperiment));
  const int senses = GENERATE(0, 1, 5, 64);
  playout_request_t request{};
  PlayoutPlan wanted = plan(Policy::kExperiment);
  wanted.soa["z07"] = 20 * kMillisecond;
  write_plan(request, 1, wanted);
  request.entries = request_for(wanted, 1).entries;
  request.count = 1;
  REQUIRE(c.push(request));
  for (int i = 0; i < senses; ++i)
    c.latency_demand().add_modality("z" + std::string(i < 10 ? "0" : "") + std::to_string(i) + std::string(60, 'z').substr(i == 7 ? 60 : 0));
  const auto m = c.next_message(at(0));
  REQUIRE(m);
  Delays found;
  const auto pages = pages_of(*m);
  REQUIRE_FALSE(pages.empty());
  for (const playout_t& page : pages) {
    CHECK(page.getEncodedSize() <= static_cast<int>(channels::kMaxMessageBytes));
    CHECK(page.count == static_cast<int>(page.entries.size()));
    CHECK(page.base_ns == m->base_ns);
    for (const auto& [name, delay] : delays_ms(page)) CHECK(found.emplace(name, delay).second);
  }
  CHECK(found == delays_ms(m));
  if (senses > 7) CHECK(plan_of(pages.front()).soa == wanted.soa);
}

TEST_CASE("Playout pages are merged in any order, ignoring repetitions and older generations") {
  playout_t whole{};
  write_plan(whole, 7, plan(Policy::kExperiment));
  for (int i = 0; i < 64; ++i) {
    playout_entry_t e{};
    e.modality = std::to_string(i) + std::string(60, 'z');
    e.delay_ns = i * kMillisecond.count();
    whole.entries.push_back(e);
  }
  whole.count = 64;
  auto pages = pages_of(whole);
  REQUIRE(pages.size() > 2);
  playout_t older = pages.front();
  older.generation = 6;
  older.entries.front().delay_ns = -1;

  playout_t heard = older;
  add_page(heard, pages.back());
  CHECK(heard.entries.size() == pages.back().entries.size());
  for (const playout_t& page : pages) add_page(heard, page);
  add_page(heard, older);
  CHECK(heard.generation == 7);
  CHECK(heard.count == 64);
  CHECK(delays_ms(heard) == delays_ms(whole));
  pages.front().entries.front().delay_ns = 500 * kMillisecond.count();
  add_page(heard, pages.front());
  CHECK(delays_ms(heard).at(pages.front().entries.front().modality) == 500);
}
