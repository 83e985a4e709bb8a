#include "sim_node/publish/known_processes.h"

#include <catch2/catch.hpp>
#include <random>

#include "sim_node/dual/followed_rate.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sim;
using tactus::test::kMs;

namespace {

constexpr std::int64_t kRun = 7;

node_health_t report(const std::string& node, std::int64_t incarnation, double realtime_factor = 0, std::int64_t run_id = kRun) {
  node_health_t m{};
  m.header.run_id = run_id;
  m.header.incarnation = incarnation;
  m.node = node;
  m.state = node_health_t::RUNNING;
  m.realtime_factor = realtime_factor;
  return m;
}

sync::HostTime at(std::int64_t ms) { return sync::host_time(ms * kMs); }

}  // namespace

TEST_CASE("Each process of the run is new once, and processes of other runs never are") {
  KnownProcesses processes("sim_node", kRun);
  processes.add_own(1);
  CHECK_FALSE(processes.is_new(report("sim_node", 1, 1), at(0)));
  CHECK(processes.is_new(report("audio_node", 2), at(0)));
  CHECK_FALSE(processes.is_new(report("audio_node", 2), at(100)));
  CHECK(processes.is_new(report("audio_node", 3), at(200)));  // it was restarted
  CHECK_FALSE(processes.is_new(report("visual_node", 4, 0, kRun + 1), at(200)));
  CHECK(processes.conflict_text(at(200)).empty());
}

TEST_CASE("Another simulation of the run is named while it reports") {
  KnownProcesses processes("sim_node", kRun);
  processes.add_own(1);
  const bool paused = GENERATE(false, true);
  processes.is_new(paused ? report("sim_node", 9, 0) : report("second_world", 9, 0.5), at(100));
  CHECK_THAT(processes.conflict_text(at(200)), Catch::Contains("another simulation"));
  CHECK(processes.conflict_text(at(1100)).empty());
  SECTION("the own reports from before a reset are none") {
    processes.add_own(5);
    for (std::int64_t ms = 1100; ms < 2000; ms += 100) processes.is_new(report("sim_node", ms % 200 ? 1 : 5, 1), at(ms));
    CHECK(processes.conflict_text(at(2000)).empty());
  }
}

TEST_CASE("Reports with random incarnations use bounded memory, and a later process is still new") {
  KnownProcesses processes("sim_node", kRun);
  std::mt19937_64 random(3);
  for (int i = 0; i < 100'000; ++i) processes.is_new(report("x", static_cast<std::int64_t>(random() >> 2) + 1), at(i));
  CHECK(processes.is_new(report("audio_node", 1), at(100'000)));
  CHECK_FALSE(processes.is_new(report("audio_node", 1), at(100'001)));
}

TEST_CASE("The followed visual rate is that of one process") {
  FollowedRate rate("visual_node");
  const auto receive = [&](std::int64_t incarnation, double rate_Hz, std::int64_t ms) {
    static std::int64_t seq = 0;
    node_health_t m = report("visual_node", incarnation);
    m.header.seq = seq++;
    m.header.publish_time_ns = ms * kMs;
    m.rate_Hz = rate_Hz;
    return rate.on_message(m, at(ms));
  };
  CHECK(receive(1, 60, 1000) == 60);
  CHECK_FALSE(receive(1, 60.5, 1100));
  CHECK_FALSE(receive(2, 10, 1110));
  CHECK(receive(1, 30, 1200) == 30);
  CHECK_FALSE(receive(2, 10, 1300));
  CHECK(receive(2, 10, 1600) == 10);
}
