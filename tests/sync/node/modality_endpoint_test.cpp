// Tests of the endpoint of a modality on the bus.
#include "sync/node/modality_endpoint.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/playout_entry_t.hpp>
#include <tactus/playout_t.hpp>

#include "sync/bus/decode.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kMillisecond;

namespace {

NodeOptions in_memory() {
  NodeOptions o;
  o.bus.memory = true;
  o.realtime = "off";
  return o;
}

contact_frame_t frame(Identity& sender, std::int64_t seq, HostTime at) {
  contact_frame_t m{};
  m.header = {seq * 1'000'000, to_ns(at), sender.clock, sender.run_id, sender.source, sender.incarnation, seq};
  m.clock = {seq * 1'000'000, to_ns(at), 1};
  m.pages = 1;
  return m;
}

}  // namespace

TEST_CASE("Messages that arrive while a tick reads its inputs are processed in that tick") {
  Node node({.name = "nose_node", .modality = "smell", .rate_Hz = 50, .fifo_priority = 0, .about = "For a test."},
            in_memory());
  ModalityEndpoint sense(node);
  auto& frames = sense.snapshots<contact_frame_t>(channels::kContacts, 64);
  Identity sender = Identity::fresh("sim_node", 1);
  const HostTime turn = host_now();
  // Sent before the tick, and during the reads: sync/bus/bus.cpp stamps a message with its time of arrival when it reads it late.
  for (const std::int64_t ms : {-1, 3, 7}) {
    const auto bytes = encode(frame(sender, 10 + ms, turn + ms * kMillisecond));
    node.bus().on_message(channels::kContacts, bytes, turn + ms * kMillisecond + kMillisecond / 10);
  }
  sense.step(turn);
  int heard = 0;
  while (const auto m = frames.pop()) ++heard;
  CHECK(heard == 3);
}

TEST_CASE("A second simulation changes nothing for a modality, does not keep its input alive, and is a conflict") {
  Node node({.name = "nose_node", .modality = "smell", .rate_Hz = 50, .fifo_priority = 0, .about = "For a test."},
            in_memory());
  ModalityEndpoint sense(node);
  auto& frames = sense.snapshots<contact_frame_t>(channels::kContacts, 64);
  Identity first = Identity::fresh("sim_node", 1), second = Identity::fresh("sim_node", 1);
  HostTime now = host_now(), last_of_first{};
  int received = 0, of_second = 0;
  for (std::int64_t ms = 0; ms < 400; ++ms, now += kMillisecond) {
    // The first one stops after 200 ms, the second one begins after 100 ms.
    for (Identity* sender : {&first, &second}) {
      if (sender == &first ? ms >= 200 : ms < 100) continue;
      node.bus().on_message(channels::kContacts, encode(frame(*sender, ms, now)), now);
      if (sender == &first) last_of_first = now;
    }
    sense.step(now);
    while (const auto m = frames.pop()) {
      ++received;
      of_second += m->message.header.incarnation == second.incarnation;
    }
    if (ms < 274) CHECK(sense.newest_arrival() == last_of_first);
    if (ms < 274) CHECK(frames.newest_arrival() == last_of_first);
    if (ms < 274) CHECK(of_second == 0);
    CHECK(sense.simulation_conflict(now) == (ms >= 100));
  }
  CHECK(received == 200 + 400 - 274);
  CHECK(of_second == 400 - 274);
}

TEST_CASE("Each input has its own newest arrival: events do not keep snapshots alive") {
  Node node({.name = "nose_node", .modality = "smell", .rate_Hz = 50, .fifo_priority = 0, .about = "For a test."},
            in_memory());
  ModalityEndpoint sense(node);
  auto& frames = sense.snapshots<contact_frame_t>(channels::kContacts, 64);
  auto& events = sense.events();
  Identity sender = Identity::fresh("sim_node", 1);
  HostTime now = host_now(), last_frame{};
  for (std::int64_t ms = 0; ms < 300; ++ms, now += kMillisecond) {
    const contact_frame_t f = frame(sender, ms, now);
    contact_events_t e{};
    e.header = f.header, e.clock = f.clock, e.pages = 1;
    if (ms < 100) node.bus().on_message(channels::kContacts, encode(f), last_frame = now);
    node.bus().on_message(channels::kContactEvents, encode(e), now);
    sense.step(now);
    while (frames.pop()) {
    }
    CHECK(frames.newest_arrival() == last_frame);
    CHECK(events.newest_arrival() == now);
  }
}

TEST_CASE("The arrival listener of a stream receives the messages of the followed simulation only, before the profile acts") {
  NodeOptions options = in_memory();
  options.profile = read_profile(R"(<profile><degrade modality="smell" delay="100ms"/></profile>)", "p.xml");
  Node node({.name = "nose_node", .modality = "smell", .rate_Hz = 50, .fifo_priority = 0, .about = "For a test."}, options);
  ModalityEndpoint sense(node);
  auto& frames = sense.snapshots<contact_frame_t>(channels::kContacts, 256);
  struct Heard {
    std::int64_t incarnation, seq;
    HostTime arrival;
  };
  std::vector<Heard> heard;
  frames.on_arrival([&](const contact_frame_t& m, HostTime arrival) { heard.push_back({m.header.incarnation, m.header.seq, arrival}); });
  Identity first = Identity::fresh("sim_node", 1), second = Identity::fresh("sim_node", 1), foreign = Identity::fresh("sim_node", 2);
  HostTime now = host_now();
  for (std::int64_t ms = 0; ms < 200; ++ms, now += kMillisecond) {
    const std::size_t before = heard.size();
    node.bus().on_message(channels::kContacts, encode(frame(first, ms, now)), now);
    if (ms > 0) node.bus().on_message(channels::kContacts, encode(frame(second, 1000 + ms, now)), now);
    if (ms > 0) node.bus().on_message(channels::kContacts, encode(frame(foreign, 2000 + ms, now)), now);
    sense.step(now);
    // At its arrival, although the profile delays it.
    REQUIRE(heard.size() == before + 1);
    CHECK(heard.back().incarnation == first.incarnation);
    CHECK(heard.back().seq == ms);
    CHECK(heard.back().arrival == now);
  }
}

TEST_CASE("A jitter of presentation has the asked mean and deviation under every policy, and the health of the node states it") {
  const bool asap = GENERATE(true, false);
  NodeOptions options = in_memory();
  options.name = "nose_node";
  options.profile = read_profile(R"(<profile><degrade modality="smell" delay="40ms" jitter="10ms normal"/></profile>)", "p.xml");
  Node node({.name = "nose_node", .modality = "smell", .rate_Hz = 50, .fifo_priority = 0, .about = "For a test."}, options);
  ModalityEndpoint sense(node);
  auto& inbox = sense.events().inbox();
  auto& healths = node.bus().queue<node_health_t>(channels::kNodeHealth, 8);
  Identity sender = Identity::fresh("sim_node", 1);
  const HostTime begin = host_now();
  if (asap) {
    playout_t plan{};
    plan.header = {-1, to_ns(begin), sender.clock, sender.run_id, sender.source, sender.incarnation, 0};
    plan.policy = playout_t::ASAP;
    plan.entries.resize(1);
    plan.entries[0].modality = "smell";
    plan.entries[0].needs_ns = -1;
    plan.count = 1;
    node.bus().on_message(channels::kPlayout, encode(plan), begin);
  }
  constexpr int kN = 4000;
  double sum_ms = 0, square = 0;
  int n = 0;
  for (int i = 0; i < kN; ++i) {
    // An event that happened 2 ms before its arrival.
    const HostTime arrival = begin + 20 * i * kMillisecond;
    contact_events_t m{};
    m.header = frame(sender, 100 + 20 * i, arrival).header;
    m.clock = {m.header.sim_time_ns, to_ns(arrival), 1};
    m.pages = m.count = 1;
    m.events.resize(1);
    m.events[0].event_id = 1 + i;
    m.events[0].kind = contact_event_t::HIT;
    m.events[0].time_ns = m.header.sim_time_ns - 2'000'000;
    m.events[0].normal.z = 1;
    m.events[0].effective_mass_kg = 1;
    node.bus().on_message(channels::kContactEvents, encode(m), arrival);
    sense.step(arrival);
    const auto map = inbox.map(arrival);
    REQUIRE(map);
    for (const contact_event_t& e : inbox.take(SimTime::max())) {
      const HostTime scheduled = sense.schedule(e.event_id, map->to_host(sim_time(e.time_ns)));
      const double late_ms = 1e3 * to_seconds(scheduled - (arrival - (asap ? 0 : 2) * kMillisecond));
      sum_ms += late_ms, square += late_ms * late_ms, ++n;
    }
    sense.publish(arrival);
    node.bus().drain(arrival);
  }
  REQUIRE(n == kN);
  const double mean_ms = sum_ms / n, sd_ms = std::sqrt(square / n - mean_ms * mean_ms);
  CHECK(mean_ms == Approx(40).margin(4.5 * 10 / std::sqrt(n)));
  CHECK(sd_ms == Approx(10).margin(4.5 * 10 / std::sqrt(2 * n)));
  node.heartbeat();
  node.bus().drain(host_now());
  const auto health = healths.pop();
  REQUIRE(health);
  CHECK_THAT(health->message.status_text, Catch::Contains("; profile effect: events +") && Catch::Contains(" ms (sd "));
}
