// Tests of the probes of a pair of hosts: datagrams, losses and offset.
#include "sync/clock_sync/pair_probe.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tactus;
using namespace tactus::sync;

namespace {

PairDatagram ask(std::uint64_t number) { return {7, PairDatagram::kRequest, number, "b", "", 1, 0, 0}; }

// An answer over a path with the delays `there` and `back`, from a clock that is `ahead` of ours.
PairDatagram answer(HostTime asked, Nanoseconds there, Nanoseconds worked, Nanoseconds ahead) {
  PairDatagram m{7, PairDatagram::kReply, 0, "b", "a", to_ns(asked), 0, 0};
  m.received_ns = to_ns(asked + there + ahead);
  m.replied_ns = m.received_ns + worked.count();
  return m;
}

}  // namespace

TEST_CASE("A datagram of a host pair is decoded as it was encoded") {
  const PairDatagram m{
      0xfedcba9876543210u, PairDatagram::kReply, 12345, "desk", "wall-left", 1, 1234567890123456789 / 2, 3};
  for (const std::size_t size : {PairDatagram::kMinBytes, PairDatagram::kMaxBytes}) {
    const auto bytes = m.encode(size);
    REQUIRE(bytes.size() == size);
    const auto back = PairDatagram::decode(bytes);
    REQUIRE(back);
    CHECK(back->run == m.run);
    CHECK(back->kind == m.kind);
    CHECK(back->number == m.number);
    CHECK(back->from == m.from);
    CHECK(back->to == m.to);
    CHECK(back->sent_ns == m.sent_ns);
    CHECK(back->received_ns == m.received_ns);
    CHECK(back->replied_ns == m.replied_ns);
  }
}

TEST_CASE("Invalid datagrams of a host pair are rejected") {
  std::mt19937 random(5);
  const auto good = ask(3).encode(PairDatagram::kMinBytes);
  REQUIRE(PairDatagram::decode(good));
  for (std::size_t size = 0; size < good.size(); ++size)
    CHECK(!PairDatagram::decode(std::span(good.data(), size)));
  CHECK(!PairDatagram::decode(std::vector<std::uint8_t>(2000, 0)));
  for (int i = 0; i < 10000; ++i) {
    auto bad = good;
    for (int k = 0; k < 4; ++k) bad[random() % bad.size()] = static_cast<std::uint8_t>(random());
    if (const auto m = PairDatagram::decode(bad)) {  // a damaged datagram may still be valid; then its values are within bounds
      CHECK(m->from.size() <= PairDatagram::kMaxName);
      CHECK(m->sent_ns >= 0);
      CHECK(m->number < 1 << 20);
    }
  }
}

TEST_CASE("The loss ratio counts missing sequence numbers, including the last ones") {
  PairRecord r;
  CHECK(r.lost() == 1);
  CHECK(!r.received());
  for (std::uint64_t i = 0; i < 90; ++i)
    if (i % 10 != 3) r.on_message(ask(i), 1);
  CHECK(r.lost() == Approx(0.1));
  PairDatagram end{7, PairDatagram::kEnd, 100, "b", "", 0, 0, 0};
  r.on_message(end, 1);
  CHECK(r.lost() == Approx(0.19));
  PairRecord late;
  for (std::uint64_t i = 50; i < 100; ++i) late.on_message(ask(i), 1);
  CHECK(late.lost() == 0);
  r.on_message(ask(5), 1);  // a repetition does not count as a second request
  CHECK(r.lost() == Approx(0.19));
  CHECK(r.ttl() == 1);
}

TEST_CASE("The offset of two clocks is within its uncertainty for asymmetric latencies") {
  std::mt19937 random(11);
  std::uniform_int_distribution<std::int64_t> way(10'000, 5'000'000), clock(-3'600'000'000'000, 3'600'000'000'000);
  for (int trial = 0; trial < 500; ++trial) {
    const Nanoseconds ahead(clock(random));
    PairRecord r;
    HostTime now = host_time(4'000'000'000'000);
    Nanoseconds least = Nanoseconds::max();
    for (int i = 0; i < 20; ++i, now += Nanoseconds(20'000'000)) {
      const Nanoseconds there(way(random)), back(way(random)), worked(30'000);
      r.on_reply(answer(now, there, worked, ahead), now + there + worked + back);
      least = std::min(least, there + back);
    }
    REQUIRE(r.replied());
    CHECK(r.round_trip(0) == least);
    const Nanoseconds error = r.offset() > ahead ? r.offset() - ahead : ahead - r.offset();
    CHECK(error <= r.uncertainty());
    CHECK(r.uncertainty() <= least / 2 + Nanoseconds(1));
  }
}

TEST_CASE("A reply with impossible times is rejected and changes nothing") {
  PairRecord r;
  const HostTime now = host_time(1'000'000'000);
  r.on_reply(answer(now, Nanoseconds(1000), Nanoseconds(-50), Nanoseconds(0)), now + Nanoseconds(2000));
  r.on_reply(answer(now, Nanoseconds(1000), Nanoseconds(9000), Nanoseconds(0)), now + Nanoseconds(2000));
  CHECK(!r.replied());
  CHECK(r.round_trip(0.5) == Nanoseconds(-1));
}
