// Tests of relays between simulated sites.
#include "sync/relay/relay.h"

#include <catch2/catch.hpp>
#include <deque>
#include <set>
#include <tactus/contact_events_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/bus/decode.h"
#include "sync/bus/identity.h"
#include "sync/log/log_header.h"

using namespace tactus;
using namespace tactus::sync;
using namespace std::chrono_literals;

namespace {

constexpr HostTime kBegin{std::chrono::hours(1)};
constexpr std::int64_t kRun = 7;

RelayRules rules(const std::string& passes) {
  return parse_relay_rules("<relay>" + passes + "</relay>", "rules.xml");
}

header_t header(const std::string& node, std::int64_t seq, HostTime at, std::int64_t sim_ns = 0,
                std::int64_t run = kRun) {
  return {sim_ns, to_ns(at), 5, run, static_cast<std::int32_t>(fnv1a_32(node)), 11, seq};
}

tool_state_t tool(std::int64_t seq, HostTime at, const std::string& node = "haptic_node",
                  std::int64_t run = kRun) {
  tool_state_t m{};
  m.header = header(node, seq, at, 0, run);
  m.device.orientation.w = m.proxy.orientation.w = 1;
  return m;
}

world_state_t world(std::int64_t seq, HostTime at, double x_m, int page = 0, int pages = 1) {
  world_state_t m{};
  m.header = header("sim_node", seq, at, (at - kBegin).count());
  m.rate_Hz = 60;
  m.page = page;
  m.pages = pages;
  m.count = 1;
  m.bodies.resize(1);
  m.bodies[0].body = page;
  m.bodies[0].position_m.x = x_m;
  m.bodies[0].orientation.w = 1;
  return m;
}

// A site: its bus, its relay and its nodes.
struct Site {
  Relay relay;
  std::vector<std::vector<std::uint8_t>> bus{};  // all messages published there
  template <class Message>
  void publish(const char* channel, const Message& m, HostTime now, bool bulk = false) {
    const auto bytes = encode(m);
    receive({channel, bytes}, bulk, now);
  }
  void receive(const ChannelBytes& m, bool bulk, HostTime now) {
    bus.emplace_back(m.data.begin(), m.data.end());
    relay.on_bus_message(m, bulk, now);
  }
};

std::vector<LineEnd> sites(int count, double bit_per_s = 0) {
  std::vector<LineEnd> ends;
  for (int i = 0; i < count; ++i)
    ends.push_back(parse_other_site("10.0.0." + std::to_string(i + 1) + ":7700")),
        ends.back().bit_per_s = bit_per_s;
  return ends;
}

// Datagrams for each line.
std::map<std::string, std::vector<std::vector<std::uint8_t>>> flushed(Relay& relay, HostTime now) {
  std::map<std::string, std::vector<std::vector<std::uint8_t>>> lines;
  relay.flush(now, [&](const LineEnd& site, std::span<const std::uint8_t> d) {
    lines[site.name].emplace_back(d.begin(), d.end());
    return true;
  });
  return lines;
}

// Carries datagrams between sites that are all linked with each other, in order of their numbers, until all lines are empty.
void carry(std::deque<Site>& all, HostTime now) {
  for (int turn = 0; turn < 10; ++turn) {
    bool moved = false;
    for (std::size_t from = 0; from < all.size(); ++from)
      for (std::size_t i = 0; i + 1 < all.size(); ++i) {
        const std::size_t to = i < from ? i : i + 1;
        const auto name = all[from].relay.sites()[i].name;
        static std::map<std::string, std::vector<std::vector<std::uint8_t>>> lines;
        if (i == 0) lines = flushed(all[from].relay, now);
        for (const auto& d : lines[name]) {
          const auto m = parse_line_datagram(d);
          REQUIRE(m);
          moved = true;
          const std::size_t side = from < to ? from : from - 1;
          if (all[to].relay.on_line_message(side, *m, now)) all[to].receive(m->message, m->bulk, now);
        }
      }
    if (!moved) return;
  }
  FAIL("messages circulate between relays");
}

}  // namespace

TEST_CASE("A line datagram is parsed as it was written") {
  const std::vector<std::uint8_t> data(channels::kMaxMessageBytes, 9);
  const auto bytes = line_datagram({"SCENE_MANIFEST", data}, true);
  CHECK(bytes.size() <= 1472);  // payload of an Ethernet frame, less IP and UDP
  const auto m = parse_line_datagram(bytes);
  REQUIRE(m);
  CHECK(m->message.channel == "SCENE_MANIFEST");
  CHECK(m->bulk);
  CHECK(std::equal(data.begin(), data.end(), m->message.data.begin(), m->message.data.end()));
}

TEST_CASE("An invalid line datagram is rejected") {
  auto bytes = line_datagram({"TOOL_STATE", {}}, false);
  REQUIRE(parse_line_datagram(bytes));
  for (std::size_t size = 0; size + 1 < bytes.size(); ++size)
    CHECK_FALSE(parse_line_datagram(std::span(bytes).first(size)));
  bytes[4] = 2;
  CHECK_FALSE(parse_line_datagram(bytes));
  CHECK_FALSE(
      parse_line_datagram(line_datagram({"X", std::vector<std::uint8_t>(channels::kMaxMessageBytes + 1)}, false)));
  CHECK_FALSE(parse_line_datagram(line_datagram({std::string(64, 'X'), {}}, false)));
}

TEST_CASE("The ends of a line are numeric addresses, host names are rejected") {
  CHECK(parse_line_end("7700").address.sin_addr.s_addr == htonl(INADDR_ANY));
  CHECK(parse_other_site("10.0.0.1:7700,2000").bit_per_s == 2e6);
  CHECK(parse_other_site("10.0.0.1:7700").bit_per_s == 0);
  for (const char* wrong :
       {"", "far:7700", "10.0.0.1", "10.0.0.1:", "10.0.0.1:0", "10.0.0.1:65536", "10.0.0.1:7.5", "10.0.0.1:7700x"})
    CHECK_THROWS_AS(parse_line_end(wrong), std::invalid_argument);
  for (const char* wrong :
       {"7700", "10.0.0.1:7700,", "10.0.0.1:7700,1", "10.0.0.1:7700,fast", "10.0.0.1:7700,nan"})
    CHECK_THROWS_AS(parse_other_site(wrong), std::invalid_argument);
}

TEST_CASE("Only channels with a rule and messages of this run pass, in both directions") {
  Relay relay(rules("<pass channel='TOOL_STATE'/>"), sites(1), kRun);
  relay.on_bus_message({"CONTACTS", encode(tool(0, kBegin))}, false, kBegin);
  CHECK(flushed(relay, kBegin).empty());
  relay.on_bus_message({"TOOL_STATE", encode(tool(0, kBegin, "haptic_node", kRun + 1))}, false, kBegin);
  relay.on_bus_message({"TOOL_STATE", std::vector<std::uint8_t>(20)}, false, kBegin);
  CHECK(flushed(relay, kBegin).empty());
  CHECK(relay.counts().bad == 2);
  relay.on_bus_message({"TOOL_STATE", encode(tool(0, kBegin))}, false, kBegin);
  CHECK(flushed(relay, kBegin).size() == 1);
  const auto far = encode(tool(0, kBegin, "haptic_node_2"));
  CHECK_FALSE(relay.on_line_message(0, {{"SIM_COMMAND", far}, false}, kBegin));
  CHECK(relay.counts().withheld == 1);
  CHECK(relay.on_line_message(0, {{"TOOL_STATE", far}, false}, kBegin));
}

TEST_CASE("A message of a rule without thinning arrives unchanged and on its port") {
  Relay relay(rules("<pass channel='SCENE_MANIFEST'/>"), sites(1), kRun);
  const auto bytes = encode(tool(41, kBegin));  // any message: only the reader checks the type
  relay.on_bus_message({"SCENE_MANIFEST", bytes}, true, kBegin);
  const auto lines = flushed(relay, kBegin);
  const auto m = parse_line_datagram(lines.begin()->second.at(0));
  REQUIRE(m);
  CHECK(m->bulk);
  CHECK(std::equal(bytes.begin(), bytes.end(), m->message.data.begin(), m->message.data.end()));
}

TEST_CASE("A thinned channel keeps its rate, and each sender has its own sequence numbers without gaps") {
  Relay relay(rules("<pass channel='TOOL_STATE' rate='60Hz'/>"), sites(1), kRun);
  std::map<std::int32_t, std::vector<std::int64_t>> numbers;
  for (int i = 0; i < 2000; ++i) {
    const HostTime t = kBegin + i * 1ms;
    relay.on_bus_message({"TOOL_STATE", encode(tool(i, t))}, false, t);
    if (i % 2 == 0) relay.on_bus_message({"TOOL_STATE", encode(tool(i / 2, t, "haptic_node_2"))}, false, t);
    for (const auto& [name, line] : flushed(relay, t))
      for (const auto& d : line) {
        const auto m = parse_line_datagram(d);
        REQUIRE(m);
        const auto state = decode<tool_state_t>(m->message.data.data(), m->message.data.size());
        REQUIRE(state);
        numbers[state->header.source].push_back(state->header.seq);
      }
  }
  REQUIRE(numbers.size() == 2);
  for (const auto& [source, sequence] : numbers) {
    CHECK(sequence.size() == Approx(120).margin(1));
    for (std::size_t i = 0; i < sequence.size(); ++i) CHECK(sequence[i] == static_cast<std::int64_t>(i));
  }
}

TEST_CASE("A message with a wrong number or time stops a thinned channel for 60 ms at most") {
  for (const auto& [number, ahead] : std::vector<std::pair<std::int64_t, Nanoseconds>>{
           {0, 500ms}, {2, 500ms}, {1000, 500ms}, {1'000'000'000, 999ms}, {1000, 0ms}, {1000, 10s}, {0, 10s}, {0, -10s}}) {
    INFO(number << " numbers and " << to_seconds(ahead) << " s ahead");
    Relay relay(rules("<pass channel='TOOL_STATE' rate='60Hz'/>"), sites(1), kRun);
    std::size_t passed_early = 0, passed = 0;
    for (int i = 0; i < 1000; ++i) {
      const HostTime t = kBegin + i * 1ms;
      relay.on_bus_message({"TOOL_STATE", encode(tool(i, t))}, false, t);
      if (i == 300) relay.on_bus_message({"TOOL_STATE", encode(tool(i + number, t + ahead))}, false, t);
      const std::size_t now = flushed(relay, t).size();
      passed += now;
      if (i > 300 && i <= 360) passed_early += now;
    }
    CHECK(passed_early >= 1);
    CHECK(passed >= 60 - 4);
    CHECK(passed <= 60 + 3);
  }
}

TEST_CASE("A jittered sender at the permitted rate loses no message") {
  Relay relay(rules("<pass channel='NODE_HEALTH' rate='10Hz'/>"), sites(1), kRun);
  std::size_t passed = 0;
  for (int i = 0; i < 300; ++i) {
    const HostTime t = kBegin + i * 100ms + (i % 3) * 7ms;
    relay.on_bus_message({"NODE_HEALTH", encode(tool(i, t))}, false, t);
    passed += flushed(relay, t).size();
  }
  CHECK(passed >= 298);
}

TEST_CASE("A deadband passes all pages of a snapshot whose change exceeds it") {
  Relay relay(rules("<pass channel='WORLD_STATE' deadband='0% position floor=1mm'/>"), sites(1), kRun);
  std::vector<double> positions;
  std::int64_t seq = 0, passed = 0;
  for (int i = 0; i < 600; ++i) {
    const HostTime t = kBegin + i * 16ms;
    const double x_m = i < 300 ? 0 : 0.0004 * (i - 300);  // rests, then 25 mm/s
    for (const int page : {0, 1})
      relay.on_bus_message({"WORLD_STATE", encode(world(seq++, t, page == 0 ? x_m : 1.0, page, 2))}, false, t);
    for (const auto& [name, line] : flushed(relay, t)) {
      CHECK(line.size() == 2);
      for (const auto& d : line) {
        const auto m = parse_line_datagram(d);
        const auto state = decode<world_state_t>(m->message.data.data(), m->message.data.size());
        REQUIRE(state);
        CHECK(state->header.seq == passed++);
        if (state->page == 0) positions.push_back(state->bodies[0].position_m.x);
      }
    }
  }
  // Once at the beginning, then every third step of 0.4 mm.
  CHECK(positions.size() == Approx(1 + 300 / 3).margin(1));
  for (std::size_t i = 1; i < positions.size(); ++i) CHECK(positions[i] - positions[i - 1] == Approx(0.0012));
}

TEST_CASE("Each message of three sites arrives once at the others and never returns") {
  std::deque<Site> all;
  for (int i = 0; i < 3; ++i) all.push_back({Relay(rules("<pass channel='TOOL_STATE'/>"), sites(2), kRun)});
  for (int i = 0; i < 50; ++i) {
    const HostTime t = kBegin + i * 1ms;
    for (int site = 0; site < 3; ++site)
      all[static_cast<std::size_t>(site)].publish("TOOL_STATE", tool(i, t, "hand_" + std::to_string(site)), t);
    carry(all, t);
  }
  for (const Site& site : all) {
    CHECK(site.bus.size() == 150);
    CHECK(std::set(site.bus.begin(), site.bus.end()).size() == 150);
  }
}

TEST_CASE("Two relays in one site create no loop") {
  // Two relays receive the bus of the first site, each with a line to the second site.
  const std::string pass = "<pass channel='TOOL_STATE'/>";
  Relay near_1(rules(pass), sites(1), kRun), near_2(rules(pass), sites(1), kRun), far(rules(pass), sites(2), kRun);
  const auto bytes = encode(tool(0, kBegin, "far_hand"));
  far.on_bus_message({"TOOL_STATE", bytes}, false, kBegin);
  CHECK(flushed(far, kBegin).size() == 2);
  // The line to the first relay is faster: its copy on the bus reaches the second relay before the line does.
  REQUIRE(near_1.on_line_message(0, {{"TOOL_STATE", bytes}, false}, kBegin));
  near_1.on_bus_message({"TOOL_STATE", bytes}, false, kBegin);
  near_2.on_bus_message({"TOOL_STATE", bytes}, false, kBegin);
  CHECK(flushed(near_1, kBegin).empty());
  const auto back = flushed(near_2, kBegin);
  REQUIRE(back.size() == 1);
  CHECK_FALSE(far.on_line_message(1, *parse_line_datagram(back.begin()->second[0]), kBegin));
  CHECK_FALSE(near_2.on_line_message(0, {{"TOOL_STATE", bytes}, false}, kBegin));
}

TEST_CASE("A slow line delays and thins only its own site") {
  auto ends = sites(2);
  ends[0].bit_per_s = 100e3;
  Relay relay(rules("<pass channel='TOOL_STATE'/><pass channel='CONTACT_EVENTS' first='true'/>"), ends, kRun);
  std::map<std::string, std::map<std::string, int>> arrived;
  for (int i = 0; i < 2000; ++i) {
    const HostTime t = kBegin + i * 1ms;
    relay.on_bus_message({"TOOL_STATE", encode(tool(i, t))}, false, t);
    contact_events_t events{};
    events.header = header("sim_node", i / 20, t);
    if (i % 20 == 0) relay.on_bus_message({"CONTACT_EVENTS", encode(events)}, false, t);
    for (const auto& [name, line] : flushed(relay, t))
      for (const auto& d : line) ++arrived[name][std::string(parse_line_datagram(d)->message.channel)];
  }
  CHECK(arrived[ends[1].name]["TOOL_STATE"] == 2000);
  CHECK(arrived[ends[0].name]["CONTACT_EVENTS"] == 100);
  CHECK(arrived[ends[0].name]["TOOL_STATE"] < 300);
  CHECK(arrived[ends[0].name]["TOOL_STATE"] > 20);
  CHECK(relay.line(0).late > 1500);
  CHECK(relay.line(1).late == 0);
  CHECK(relay.status_text(kBegin).find("too slow") != std::string::npos);
}

TEST_CASE("A sender may move to another site after a long silence") {
  SenderSides sides;
  const header_t h = header("audio_node", 0, kBegin);
  CHECK(sides.belongs_to(h, 1, kBegin));
  CHECK_FALSE(sides.belongs_to(h, SenderSides::kHere, kBegin + 5s));
  CHECK(sides.belongs_to(h, SenderSides::kHere, kBegin + 11s));
  CHECK_FALSE(sides.belongs_to(h, 1, kBegin + 12s));
}

TEST_CASE("The number of remembered senders is bounded") {
  SenderSides sides;
  for (std::int32_t i = 0; i < 10'000; ++i) {
    header_t h = header("a", 0, kBegin);
    h.source = i;
    CHECK(sides.belongs_to(h, 1, kBegin + Nanoseconds(i)));
  }
  header_t oldest = header("a", 0, kBegin), newest = oldest;
  oldest.source = 0, newest.source = 9'999;
  CHECK_FALSE(sides.belongs_to(newest, 2, kBegin + 1ms));
  CHECK(sides.belongs_to(oldest, 2, kBegin + 1ms));
}
