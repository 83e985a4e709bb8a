// Tests of the bus within one process: LCM's memq transport, no network.
#include "sync/bus/bus.h"

#include <catch2/catch.hpp>
#include <tactus/asset_request_t.hpp>
#include <tactus/clock_map_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/media_clock_t.hpp>
#include <tactus/world_state_t.hpp>

using namespace tactus;

namespace {

const sync::HostTime kNow = sync::host_time(5'000'000'000);

sync::BusOptions memory() {
  sync::BusOptions options;
  options.memory = true;
  return options;
}

sync::Identity me() { return sync::Identity::fresh("test_node", 9); }

asset_request_t request(int chunk) {
  asset_request_t m{};
  m.header.sim_time_ns = -1;
  m.first_chunk = chunk;
  m.chunk_count = 1;
  return m;
}

}  // namespace

TEST_CASE("Published messages arrive once, stamped and in order") {
  sync::Bus bus(me(), memory());
  auto& queue = bus.queue<asset_request_t>("A", 100);
  for (int i = 0; i < 10; ++i) {
    asset_request_t m = request(i);
    REQUIRE(bus.publish("A", m));
  }
  bus.drain(kNow);
  for (int i = 0; i < 10; ++i) {
    const auto r = queue.pop();
    REQUIRE(r);
    CHECK(r->message.first_chunk == i);
    CHECK(r->arrival == kNow);
    const header_t& h = r->message.header;
    CHECK(h.seq == i);
    CHECK(h.run_id == 9);
    CHECK(h.source == bus.identity().source);
    CHECK(h.incarnation == bus.identity().incarnation);
    CHECK(h.publish_time_ns > 0);
    CHECK(h.sim_time_ns == -1);
    CHECK(r->sequence_status == (i == 0 ? sync::SequenceStatus::kNewIncarnation : sync::SequenceStatus::kNew));
  }
  CHECK_FALSE(queue.pop());
  CHECK(queue.count().sequence.gaps() == 0);
}

TEST_CASE("Receivers count a new incarnation as a restart and not as lost messages") {
  sync::Bus bus(me(), memory());
  auto& queue = bus.queue<asset_request_t>("A", 100);
  const std::int64_t before = bus.identity().incarnation;
  asset_request_t m = request(0);
  for (int i = 0; i < 5; ++i) bus.publish("A", m);
  bus.begin_incarnation();
  for (int i = 0; i < 3; ++i) bus.publish("A", m);
  bus.drain(kNow);
  for (int i = 0; i < 8; ++i) {
    const auto r = queue.pop();
    REQUIRE(r);
    CHECK(r->message.header.seq == (i < 5 ? i : i - 5));
    CHECK((r->message.header.incarnation == before) == (i < 5));
    CHECK((r->sequence_status == sync::SequenceStatus::kNewIncarnation) == (i == 0 || i == 5));
  }
  CHECK(bus.identity().incarnation > 0);
  CHECK(queue.count().sequence.gaps() == 0);
}

TEST_CASE("Each channel has its own sequence numbers and subscribers") {
  sync::Bus bus(me(), memory());
  auto& a = bus.queue<asset_request_t>("A", 4);
  auto& ab = bus.queue<asset_request_t>("AB", 4);
  asset_request_t m = request(1);
  bus.publish("A", m);
  bus.publish("A", m);
  bus.publish("AB", m);
  bus.drain(kNow);
  CHECK(a.pop()->message.header.seq == 0);
  CHECK(a.pop()->message.header.seq == 1);
  CHECK(ab.pop()->message.header.seq == 0);
  CHECK(a.count().sequence.messages() == 2);
}

TEST_CASE("A full queue drops the oldest message and counts it") {
  sync::Bus bus(me(), memory());
  auto& queue = bus.queue<asset_request_t>("A", 4);
  for (int i = 0; i < 10; ++i) {
    asset_request_t m = request(i);
    bus.publish("A", m);
  }
  bus.drain(kNow);
  CHECK(queue.count().dropped == 6);
  CHECK(queue.pop()->message.first_chunk == 6);
}

TEST_CASE("A burst of 8000 messages arrives without loss") {
  sync::Bus bus(me(), memory());
  auto& queue = bus.queue<asset_request_t>("A", 100000);
  for (int i = 0; i < 8000; ++i) {
    asset_request_t m = request(i);
    bus.publish("A", m);
  }
  bus.drain(kNow);
  CHECK(queue.count().sequence.messages() == 8000);
  CHECK(queue.count().sequence.gaps() == 0);
}

TEST_CASE("A bad message is counted and dropped, and the next good one arrives") {
  sync::Bus bus(me(), memory());
  auto& queue = bus.queue<asset_request_t>("A", 4);
  asset_request_t wrong = request(0);
  wrong.chunk_count = -5;
  bus.publish("A", wrong);
  media_clock_t other{};
  other.medium = "x";
  bus.publish("A", other);
  bus.drain(kNow);
  CHECK_FALSE(queue.pop());
  CHECK(queue.count().bad == 2);
  asset_request_t good = request(3);
  bus.publish("A", good);
  bus.drain(kNow);
  CHECK(queue.pop()->message.first_chunk == 3);
}

TEST_CASE("A message above 1400 bytes is rejected before it is sent") {
  sync::Bus bus(me(), memory());
  auto& queue = bus.queue<world_state_t>("W", 4);
  world_state_t m{};
  m.pages = 1;
  m.bodies.resize(100);
  m.count = 100;
  CHECK_FALSE(bus.publish("W", m));
  CHECK(bus.refused() == 1);
  bus.drain(kNow);
  CHECK_FALSE(queue.pop());
  CHECK(queue.count().bad == 0);
}

TEST_CASE("A subscription to both ports receives each message once") {
  sync::Bus bus(me(), memory());
  auto& queue = bus.queue<asset_request_t>("A", 100, sync::Port::kBoth);
  asset_request_t m = request(0);
  bus.publish("A", m, sync::Port::kBoth);
  bus.publish("A", m, sync::Port::kBulk);
  bus.drain(kNow);
  CHECK(queue.count().sequence.messages() == 2);
}

TEST_CASE("wait() returns at once when a message has arrived") {
  sync::Bus bus(me(), memory());
  auto& queue = bus.queue<asset_request_t>("A", 4);
  asset_request_t m = request(0);
  bus.publish("A", m);
  bus.wait(std::chrono::seconds(2));
  bus.drain(kNow);
  CHECK(queue.pop());
}

TEST_CASE("The LCM URL contains group, port and time to live") {
  sync::BusOptions options;
  options.ttl = 1;
  const std::string url = sync::lcm_url(options, 7000);
  CHECK(url == "udpm://239.255.76.67:7000?ttl=1");
}

TEST_CASE("The age of an input is measured on the sender's clock if it is mapped, otherwise since arrival") {
  using namespace tactus::sync;
  ClockMaps maps(7);
  clock_map_t m{};
  m.header.run_id = 7;
  m.of_clock = 2, m.to_clock = 1, m.offset_ns = 1'000'000, m.uncertainty_ns = 100;
  maps.observe(m, host_time(0));
  const OwnClock own(7, 1, &maps);
  InputCount in;
  CHECK(age_of(in, own, host_time(5000)).age == Nanoseconds(-1));
  in.newest_publish_ns = 2000, in.newest_run_id = 7, in.newest_clock = 1, in.newest_arrival = host_time(4000);
  CHECK(age_of(in, own, host_time(5000)).age == Nanoseconds(3000));
  CHECK(age_of(in, own, host_time(5000)).uncertainty == Nanoseconds(0));
  in.newest_clock = 2, in.newest_publish_ns = 1'002'500;
  CHECK(age_of(in, own, host_time(5000)).age == Nanoseconds(2500));
  CHECK(age_of(in, own, host_time(5000)).uncertainty >= Nanoseconds(100));
  const auto by_arrival = [&] {
    const InputAge age = age_of(in, own, host_time(5000));
    return age.age == Nanoseconds(1000) && age.uncertainty == Nanoseconds(-1);
  };
  in.newest_clock = 3;
  CHECK(by_arrival());
  in.newest_clock = 1, in.newest_run_id = 8;
  CHECK(by_arrival());
}
