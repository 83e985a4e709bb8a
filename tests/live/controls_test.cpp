// Tests on a bus within this process: LCM's memq transport, no network, a manual clock.
#include "scripts/live/controls.h"

#include <catch2/catch.hpp>
#include <tactus/degradation_t.hpp>
#include <tactus/device_state_t.hpp>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <tactus/tag_request_t.hpp>

#include "lcmtypes/channels.h"
#include "lcmtypes/generation.h"
#include "sync/bus/bus.h"
#include "sync/degradation/profile.h"
#include "sync/bus/identity.h"

using namespace tactus;
using namespace tactus::live;

namespace {

constexpr std::int64_t kRealtime_ns = 1'700'000'000'000'000'000;

sync::BusOptions memory() {
  sync::BusOptions options;
  options.memory = true;
  return options;
}

struct PageFixture {
  sync::Bus bus{sync::Identity::fresh("live_server", 9), memory()};
  std::vector<std::pair<std::string, bool>> replies;
  Controls controls{bus, [this](const std::string& sentence, bool good) { replies.emplace_back(sentence, good); }};
  sync::Queue<sim_command_t>& commands = bus.queue<sim_command_t>(channels::kSimCommand, 100);
  sync::Queue<degradation_t>& profiles = bus.queue<degradation_t>(channels::kDegradation, 100);
  sync::Queue<tag_request_t>& tags = bus.queue<tag_request_t>(channels::kTagRequest, 100);
  sync::HostTime now = sync::host_time(5'000'000'000);

  void run_for(double s) {
    for (const sync::HostTime end = now + sync::from_seconds(s); now < end; now += sync::from_seconds(0.005)) {
      bus.drain(now);
      controls.step(now);
    }
    bus.drain(now);
  }
  template <class Message>
  static std::vector<Message> all(sync::Queue<Message>& queue) {
    std::vector<Message> out;
    while (auto m = queue.pop()) out.push_back(m->message);
    return out;
  }
  void in_force(const std::string& xml, std::int64_t generation) {
    sync::ProfileInForce p;
    p.text = xml;
    p.hash = sync::fnv1a_64(xml.data(), xml.size());
    p.generation = generation;
    sync::send_profile(bus, p);
    run_for(0.02);
    all(profiles);
  }
};

}  // namespace

TEST_CASE("A command is repeated with one id until its reply, and the reply is shown") {
  PageFixture p;
  p.controls.command({sim_command_t::STEP, 25}, p.now);
  p.run_for(0.45);
  const auto sent = PageFixture::all(p.commands);
  REQUIRE(sent.size() == 5);  // at once, and each tenth of a second
  for (const auto& m : sent) {
    CHECK(m.id == sent[0].id);
    CHECK((m.kind == sim_command_t::STEP && m.steps == 25));
  }
  sim_reply_t reply{};
  reply.header.sim_time_ns = -1;
  reply.id = sent[0].id + 1;  // the id of another request
  reply.done = 1;
  reply.text = "other";
  p.bus.publish(channels::kSimReply, reply);
  p.run_for(0.01);
  CHECK(p.replies.empty());
  reply.id = sent[0].id;
  reply.text = "25 steps";
  p.bus.publish(channels::kSimReply, reply);
  p.run_for(0.01);
  CHECK(p.replies == std::vector<std::pair<std::string, bool>>{{"25 steps", true}});
  PageFixture::all(p.commands);
  p.run_for(5);
  CHECK(PageFixture::all(p.commands).empty());
  CHECK(p.replies.size() == 1);
}

TEST_CASE("A command without a reply fails after three seconds, with a sentence") {
  PageFixture p;
  p.controls.command({sim_command_t::PAUSE, 0}, p.now);
  p.run_for(10);
  CHECK(PageFixture::all(p.commands).size() <= 31);
  REQUIRE(p.replies.size() == 1);
  CHECK_THAT(p.replies[0].first, Catch::Contains("no reply from sim_node"));
  CHECK_FALSE(p.replies[0].second);
}

TEST_CASE("Sliders start from the profile in force, and show the newest profile") {
  PageFixture p;
  CHECK_FALSE(p.controls.profile());
  p.in_force(R"(<profile name="by hand" seed="3"><degrade modality="visual" delay="5ms network" jitter="5ms"/></profile>)", kRealtime_ns + 50);
  REQUIRE(p.controls.profile());
  CHECK(p.controls.profile()->generation == kRealtime_ns + 50);

  // A clock that was set back must not make the page's request the older one.
  p.controls.degrade({{{"audio", {80, 0, 0}}}, false}, kRealtime_ns, p.now);
  p.run_for(0.05);
  const auto sent = PageFixture::all(p.profiles);
  REQUIRE_FALSE(sent.empty());
  CHECK(sent[0].generation > kRealtime_ns + 50);
  const auto profile = sync::parse_profile(sent[0].text, "sent");
  REQUIRE(profile.rules.size() == 2);
  CHECK(profile.rules[0].jitter);
  CHECK(profile.rules[1].delay->delay_s == Approx(0.08));
  CHECK(p.controls.profile()->hash == sent[0].hash);

  SECTION("all well removes all operators") {
    p.controls.degrade({{{"audio", {0, 0, 0}}}, true}, kRealtime_ns + 1000, p.now);
    p.run_for(0.05);
    const auto well = PageFixture::all(p.profiles);
    REQUIRE_FALSE(well.empty());
    CHECK(sync::parse_profile(well.back().text, "well").rules.empty());
  }
  SECTION("it is sent for two seconds, and then repeated by sync_node") {
    p.run_for(3);
    CHECK(PageFixture::all(p.profiles).size() < 25);
    p.run_for(3);
    CHECK(PageFixture::all(p.profiles).empty());
  }
  SECTION("a profile of any date is replaced") {
    p.in_force(R"(<profile name="ahead"/>)", kMaxGeneration - 1);
    p.controls.degrade({{{"audio", {80, 0, 0}}}, false}, kRealtime_ns, p.now);
    p.run_for(0.05);
    const auto next = PageFixture::all(p.profiles);
    REQUIRE_FALSE(next.empty());
    CHECK(next.back().generation == kMaxGeneration);
    p.in_force(R"(<profile name="forged"/>)", INT64_MAX);  // refused where it enters
    CHECK(p.controls.profile()->hash == next.back().hash);
    p.controls.degrade({{{"audio", {90, 0, 0}}}, false}, kRealtime_ns, p.now);
    CHECK(p.controls.profile()->generation == kMaxGeneration);
  }
  SECTION("a later profile of another sender replaces it") {
    p.in_force(R"(<profile name="later"><degrade modality="haptic" off="true"/></profile>)", kRealtime_ns + 9999);
    CHECK(p.controls.profile()->generation == kRealtime_ns + 9999);
  }
}

TEST_CASE("Tags are requested once a second while a page watches them") {
  PageFixture p;
  p.controls.request_tags({"sim_node.work.collision"}, p.now);
  p.run_for(2.95);
  const auto requests = PageFixture::all(p.tags);
  REQUIRE(requests.size() == 3);
  for (const auto& m : requests) CHECK(m.patterns == std::vector<std::string>{"sim_node.work.collision"});
  std::vector<std::string> many;
  for (int i = 0; i < 17; ++i) many.push_back("node.tag" + std::to_string(i));
  p.controls.request_tags(many, p.now);
  p.run_for(0.02);
  CHECK(PageFixture::all(p.tags).back().patterns == std::vector<std::string>{"*"});  // more than a request can name
}

TEST_CASE("No page can move a tool before the scene is known") {
  PageFixture p;
  CHECK_THROWS_WITH(p.controls.hand({0, 0, 0, false}, 1.33, p.now), Catch::Contains("not known yet"));
  p.run_for(0.1);
  auto& devices = p.bus.queue<device_state_t>(channels::kDeviceState, 10);
  p.run_for(0.1);
  CHECK_FALSE(devices.pop());
}
