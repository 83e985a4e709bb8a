// Tests of the event and health feed of the live page.
#include "scripts/live/feed.h"

#include <catch2/catch.hpp>
#include <random>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presented_t.hpp>

#include "tests/live/live_time.h"
#include "tests/sync/support/memory_sink.h"

using namespace tactus;
using namespace tactus::live;
using nlohmann::json;
using tactus::test::at;

namespace {

constexpr std::int64_t kRun = 7;
constexpr std::int64_t kMs = 1'000'000;

contact_events_t hit(std::int64_t id, double sim_ms, std::int64_t run = kRun) {
  contact_events_t m{};
  m.header = sync::header_of("sim_node", 1, id, 1, run);
  // Simulated time 0 is at 10 s of the host.
  m.clock.host_ns = 10'000'000'000;
  m.clock.rate = 1;
  m.pages = 1;
  m.count = 1;
  m.events.resize(1);
  m.events[0].event_id = id;
  m.events[0].kind = contact_event_t::HIT;
  m.events[0].time_ns = static_cast<std::int64_t>(sim_ms * 1e6);
  m.events[0].body_b = 1;
  m.events[0].tool = -1;
  m.events[0].normal.z = 1;
  m.events[0].approach_speed_m_s = 0.5;
  m.events[0].effective_mass_kg = 0.1;
  return m;
}
presented_t presented(const std::string& modality, std::int64_t id, double host_ms, std::int32_t clock = 0) {
  presented_t m{};
  m.header = sync::header_of(modality + "_node", 1, id, 1);
  m.header.clock = clock;
  m.modality = modality;
  m.count = 1;
  m.reports.resize(1);
  m.reports[0].event_id = id;
  m.reports[0].presented_ns = m.reports[0].ready_ns = m.reports[0].scheduled_ns =
      10'000 * kMs + static_cast<std::int64_t>(host_ms * 1e6);
  return m;
}
node_health_t health(const std::string& node, std::int64_t run = kRun) {
  node_health_t m{};
  m.header = sync::header_of(node, 1, 0, 1, run);
  m.node = node;
  m.modality = "audio";
  m.state = node_health_t::RUNNING;
  m.tool = -1;
  m.rate_Hz = m.nominal_rate_Hz = 375;
  return m;
}

struct FeedInput {
  Feed feed{kRun};
  template <class Message>
  void on_message(const char* channel, const Message& m, double s = 0) {
    const auto bytes = sync::encode(m);
    feed.on_message(channel, bytes, at(s));
  }
};

}  // namespace

TEST_CASE("An event and its presentation are sent once, with the latency between them") {
  FeedInput f;
  for (int copy = 0; copy < 3; ++copy) {  // events and reports are repeated on the bus
    f.on_message(channels::kContactEvents, hit(1, 100));
    f.on_message(channels::kPresented, presented("audio", 1, 130));
  }
  const json changes = f.feed.take_changes(at(1));
  REQUIRE(changes["events"].size() == 1);
  CHECK(changes["events"][0][0] == Approx(10.1));
  CHECK(changes["events"][0][1] == contact_event_t::HIT);
  CHECK(changes["events"][0][4] == Approx(0.5));
  REQUIRE(changes["presented"].size() == 1);
  CHECK(changes["presented"][0][0] == Approx(10.13));
  CHECK(changes["presented"][0][1] == "audio");
  CHECK(changes["presented"][0][4] == Approx(30));
  CHECK_FALSE(f.feed.take_changes(at(1.01)).contains("events"));
}

TEST_CASE("Times of two clocks are not compared: the presentation is drawn at its event, without a latency") {
  FeedInput f;
  f.on_message(channels::kContactEvents, hit(1, 100));
  f.on_message(channels::kPresented, presented("audio", 1, 777'000, 42));
  const json changes = f.feed.take_changes(at(1));
  REQUIRE(changes["presented"].size() == 1);
  CHECK(changes["presented"][0][0] == Approx(10.1));
  CHECK(changes["presented"][0][4].is_null());
}

TEST_CASE("The health of nodes is sent four times a second, and silent nodes are sent as lost") {
  FeedInput f;
  f.on_message(channels::kNodeHealth, health("audio_node"), 0);
  json first = f.feed.take_changes(at(0.1));
  REQUIRE(first["health"].size() == 1);
  CHECK(first["health"][0]["node"] == "audio_node");
  CHECK(first["health"][0]["source"] == static_cast<std::int32_t>(sync::fnv1a_32("audio_node")));
  CHECK(first["health"][0]["lost"] == false);
  CHECK_FALSE(f.feed.take_changes(at(0.2)).contains("health"));
  CHECK(f.feed.take_changes(at(0.4)).contains("health"));
  CHECK(f.feed.state(at(1.4))["health"][0]["lost"] == false);
  CHECK(f.feed.state(at(1.6))["health"][0]["lost"] == true);
  CHECK(f.feed.state(at(1.6))["health"][0]["modality"] == "audio");
  f.feed.clear();
  CHECK(f.feed.state(at(2))["health"].empty());
}

TEST_CASE("Events of another run are ignored, and a log shows all runs") {
  FeedInput live, log{Feed(0)};
  for (FeedInput* f : {&live, &log}) {
    f->on_message(channels::kNodeHealth, health("audio_node", kRun + 1));
    f->on_message(channels::kContactEvents, hit(1, 1, kRun + 1));
  }
  CHECK(live.feed.take_changes(at(0)).empty());
  CHECK(log.feed.take_changes(at(0)).contains("health"));
  CHECK(log.feed.state(at(0))["health"].size() == 1);
}

TEST_CASE("A flood is bounded and its dropped events are counted, and malformed messages are ignored") {
  FeedInput f;
  for (int i = 0; i < 10'000; ++i) {
    f.on_message(channels::kContactEvents, hit(i, i));
    f.on_message(channels::kPresented, presented("audio", i, i + 30));
  }
  for (int i = 0; i < 200; ++i) f.on_message(channels::kNodeHealth, health("node_" + std::to_string(i)));
  const json changes = f.feed.take_changes(at(0));
  CHECK(changes["events"].size() == Feed::kMaxPerFrame);
  CHECK(changes["presented"].size() == Feed::kMaxPerFrame);
  CHECK(changes["left_out"] == 2 * (10'000 - Feed::kMaxPerFrame));
  CHECK(changes["health"].size() == Feed::kMaxNodes);

  std::mt19937 random(1);
  const std::vector<std::vector<std::uint8_t>> good{sync::encode(hit(1, 1)), sync::encode(presented("audio", 1, 1)),
                                                    sync::encode(health("audio_node"))};
  const char* channels[]{channels::kContactEvents, channels::kPresented, channels::kNodeHealth};
  for (std::size_t i = 0; i < 3000; ++i) {
    auto bytes = good[i % 3];
    bytes.resize(random() % bytes.size());
    f.feed.on_message(channels[(i + i / 3) % 3], bytes, at(1));
  }
  CHECK_NOTHROW(f.feed.take_changes(at(2)).dump());
}
