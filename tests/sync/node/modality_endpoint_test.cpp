// Tests of the endpoint of a modality on the bus.
#include "sync/node/modality_endpoint.h"

#include <catch2/catch.hpp>
#include <tactus/contact_frame_t.hpp>

#include "sync/bus/decode.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

constexpr Nanoseconds kMs{1'000'000};

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
    const auto bytes = encode(frame(sender, 10 + ms, turn + ms * kMs));
    node.bus().on_message(channels::kContacts, bytes, turn + ms * kMs + kMs / 10);
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
  for (std::int64_t ms = 0; ms < 400; ++ms, now += kMs) {
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
    if (ms < 274) CHECK(of_second == 0);
    CHECK(sense.simulation_conflict(now) == (ms >= 100));
  }
  CHECK(received == 200 + 400 - 274);
  CHECK(of_second == 400 - 274);
}
