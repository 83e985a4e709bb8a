// Tests of programs in virtual time.
#include "sync/virtual_time/virtual_time.h"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <tactus/node_health_t.hpp>

#include "sync/node/node.h"
#include "sync/node/background_task.h"
#include "sync/clocks/pacing.h"

using namespace tactus;
using namespace tactus::sync;
using namespace std::chrono_literals;

namespace {

using Trace = std::vector<std::pair<std::string, HostTime>>;

// Two loops that sleep and record the time of each wake-up.
Trace two_loops(std::uint64_t seed) {
  Trace trace;
  VirtualTime time({.seed = seed});
  const auto loop = [&](const char* name, Nanoseconds period) {
    return [&trace, &time, name, period] {
      for (HostTime next = host_now(); !time.stop_requested(); sleep_until(next += period)) trace.emplace_back(name, host_now());
      return 0;
    };
  };
  time.add("fast", loop("fast", 1ms));
  time.add("slow", loop("slow", 7ms));
  time.run_for(1s);
  time.end();
  return trace;
}

// Sets a flag when it is destroyed.
struct Flag {
  bool& raised;
  ~Flag() { raised = true; }
};

}  // namespace

TEST_CASE("Programs wake in the order of their deadlines, and a virtual hour passes at once") {
  const Trace trace = two_loops(3);
  CHECK(std::is_sorted(trace.begin(), trace.end(), [](auto& a, auto& b) { return a.second < b.second; }));
  CHECK(std::count_if(trace.begin(), trace.end(), [](auto& row) { return row.first == "slow"; }) == 143);  // 1000 / 7, and the first one

  VirtualTime time;
  HostTime woke{};
  time.add("sleeper", [&] {
    sleep_until(host_now() + 1h);
    woke = host_now();
    return 5;
  });
  time.run_for(59min);
  CHECK(time.any());
  CHECK(woke == HostTime{});
  CHECK(time.result("sleeper") == -1);
  time.run_for(2min);
  CHECK(woke > VirtualTime::kBegin + 1h);
  CHECK(woke < VirtualTime::kBegin + 1h + 1ms);
  CHECK(time.now() == VirtualTime::kBegin + 61min);
  CHECK_FALSE(time.any());
  CHECK(time.result("sleeper") == 5);
}

TEST_CASE("The same seed gives the same trace, another seed gives another") {
  CHECK(two_loops(3) == two_loops(3));
  CHECK(two_loops(3) != two_loops(4));
}

TEST_CASE("A frozen program does nothing until it continues, and the others are not affected") {
  VirtualTime time({.seed = 3});
  Trace trace;
  const auto loop = [&](const char* name) {
    return [&trace, &time, name] {
      for (HostTime next = host_now(); !time.stop_requested(); sleep_until(next += 1ms)) trace.emplace_back(name, host_now());
      return 0;
    };
  };
  time.add("frozen", loop("frozen"));
  time.add("other", loop("other"));
  time.run_for(100ms);
  CHECK_FALSE(time.freeze("nobody", time.now() + 1s));
  const HostTime from = time.now(), until = from + 250ms;
  CHECK(time.freeze("frozen", until));
  time.run_for(1s);
  int meanwhile = 0, others = 0;
  for (const auto& [name, at] : trace) {
    const bool between = at > from && at < until;
    (name == "frozen" ? meanwhile : others) += between;
  }
  CHECK(meanwhile == 0);
  CHECK(others == 250);
  CHECK(std::find(trace.begin(), trace.end(), std::pair<std::string, HostTime>("frozen", until)) != trace.end());
  time.end();
}

TEST_CASE("A message does not wake a frozen program, and waits for it") {
  VirtualTime time;
  HostTime woke{};
  time.add("reader", [&] {
    Bus bus(Identity::fresh("reader", 1), {});
    auto& queue = bus.queue<node_health_t>(channels::kNodeHealth, 8);
    while (!time.stop_requested()) {
      bus.wait(10s);
      bus.drain(host_now());
      if (queue.pop()) woke = host_now();
    }
    return 0;
  });
  time.run_for(10ms);
  const HostTime until = time.now() + 500ms;
  CHECK(time.freeze("reader", until));
  Bus sender(Identity::fresh("sender", 1), {});
  node_health_t health{};
  health.node = "sender";
  health.qualities = 1;
  health.kernel_drops = -1;
  sender.publish(channels::kNodeHealth, health);
  time.run_for(400ms);
  CHECK(woke == HostTime{});
  time.run_for(200ms);
  CHECK(woke == until);
}

TEST_CASE("A program ends on request, and is unwound at the timeout") {
  VirtualTime time;
  bool polite = false, stubborn = false;
  time.add("polite", [&] {
    const Flag flag{polite};
    while (!time.stop_requested()) sleep_until(host_now() + 1ms);
    return 7;
  });
  time.add("stubborn", [&] {
    const Flag flag{stubborn};
    while (true) sleep_until(host_now() + 1ms);
    return 0;
  });
  time.run_for(10ms);
  CHECK(time.request_stop("polite"));
  time.run_for(2ms);
  CHECK(time.result("polite") == 7);
  CHECK(polite);
  CHECK_FALSE(stubborn);
  time.end(100ms);
  CHECK(stubborn);
  CHECK_FALSE(time.any());
}

TEST_CASE("run_for() rethrows an exception of a program, and the other programs continue") {
  VirtualTime time;
  int woke = 0;
  time.add("thrower", [] {
    sleep_until(host_now() + 5ms);
    throw std::runtime_error("no more");
    return 0;
  });
  time.add("other", [&] {
    while (!time.stop_requested()) ++woke, sleep_until(host_now() + 1ms);
    return 0;
  });
  CHECK_THROWS_WITH(time.run_for(1s), "no more");
  time.run_for(10ms);
  CHECK(woke > 12);
  time.end();
}

TEST_CASE("Only one virtual time exists at once, and only its programs may sleep in it") {
  CHECK(VirtualTime::current() == nullptr);
  {
    VirtualTime time;
    CHECK(VirtualTime::current() == &time);
    CHECK_THROWS_AS(VirtualTime(), std::logic_error);
    CHECK_THROWS_AS(sleep_until(host_now() + 1ms), std::logic_error);
  }
  CHECK(VirtualTime::current() == nullptr);
  CHECK(host_now() != VirtualTime::kBegin);
}

TEST_CASE("A background task in virtual time is done at once") {
  VirtualTime time;
  BackgroundTask<int> opening([] { return std::make_unique<int>(4); });
  REQUIRE(opening.done());
  CHECK(*opening.take() == 4);
}

TEST_CASE("A node in virtual time ticks at its deadlines and reports ten times a second") {
  VirtualTime time({.seed = 9});
  std::vector<HostTime> ticks;
  node_health_t last{};
  int reports = 0;
  time.add("node", [&] {
    NodeOptions options;
    options.name = "test_node";
    Node node({.name = "test_node", .modality = "", .rate_Hz = 1000, .about = ""}, options);
    while (node.running()) ticks.push_back(node.wait());
    return 0;
  });
  time.add("listener", [&] {
    Bus bus(Identity::fresh("listener", 1), {});
    auto& healths = bus.queue<node_health_t>(channels::kNodeHealth, 64);
    while (!time.stop_requested()) {
      bus.wait(1s);
      bus.drain(host_now());
      while (const auto m = healths.pop()) last = m->message, ++reports;
    }
    return 0;
  });
  time.run_for(5s);
  time.end();
  REQUIRE(ticks.size() > 4999);
  for (std::size_t i = 2; i < ticks.size(); ++i) REQUIRE(ticks[i] - ticks[i - 1] == 1ms);
  CHECK(reports >= 49);
  CHECK(last.missed_ticks == 0);
  CHECK(last.kernel_drops == 0);
}
