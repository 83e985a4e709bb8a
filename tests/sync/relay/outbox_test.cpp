// Tests of the rate-limited outbox of a relay.
#include "sync/relay/outbox.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tactus::sync;
using namespace std::chrono_literals;

namespace {

constexpr HostTime kOpened{std::chrono::hours(1)};

std::vector<std::uint8_t> datagram(std::uint8_t first, std::size_t size = 1000) {
  std::vector<std::uint8_t> bytes(size, 0);
  bytes[0] = first;
  return bytes;
}

// Flushes every 2 ms for `length`, and returns the flushed messages.
std::vector<int> flushed(Outbox& outbox, HostTime from, Nanoseconds length) {
  std::vector<int> sent;
  for (HostTime t = from; t < from + length; t += 2ms)
    outbox.flush(t, [&](std::span<const std::uint8_t> d) {
      sent.push_back(d[0]);
      return true;
    });
  return sent;
}

}  // namespace

TEST_CASE("An outbox without a rate limit sends at once and in order") {
  Outbox outbox(0);
  for (std::uint8_t i = 0; i < 100; ++i) outbox.push(Urgency::kState, datagram(i), kOpened);
  const auto sent = flushed(outbox, kOpened, 1ns);
  REQUIRE(sent.size() == 100);
  CHECK(std::is_sorted(sent.begin(), sent.end()));
  CHECK(outbox.counts().bytes == 100'000);
}

TEST_CASE("Urgent messages are sent first") {
  Outbox outbox(1e6);
  for (int i = 0; i < 60; ++i) {
    outbox.push(Urgency::kBulk, datagram(3), kOpened);
    outbox.push(Urgency::kState, datagram(2), kOpened);
    outbox.push(Urgency::kFirst, datagram(1, 100), kOpened);
  }
  const auto sent = flushed(outbox, kOpened, 40ms);
  CHECK(std::count(sent.begin(), sent.end(), 1) == 60);
  CHECK(std::is_sorted(sent.begin(), sent.end()));
}

TEST_CASE("A message that waits for 50 ms is dropped and counted, an asset after a second") {
  Outbox outbox(8 * 16'000);  // 16 kB per second
  for (int i = 0; i < 100; ++i) outbox.push(Urgency::kState, datagram(2), kOpened);
  outbox.push(Urgency::kBulk, datagram(3), kOpened);
  const auto sent = flushed(outbox, kOpened, 500ms);
  // 15 of 1028 bytes in the burst; the rest of the burst and 50 ms give one more.
  CHECK(std::count(sent.begin(), sent.end(), 2) == 16);
  CHECK(outbox.counts().late == 84);
  // Half of the burst is available again after 540 ms.
  CHECK(std::count(sent.begin(), sent.end(), 3) == 0);
  CHECK(flushed(outbox, kOpened + 500ms, 200ms) == std::vector<int>{3});
  outbox.push(Urgency::kBulk, datagram(3), kOpened + 700ms);
  outbox.flush(kOpened + 5s, [](auto) { return true; });
  CHECK(outbox.counts().late == 84);
  CHECK(outbox.counts().late_bulk == 1);
}

TEST_CASE("Assets leave room for a group of state messages") {
  Outbox outbox(1e6);
  for (int i = 0; i < 200; ++i) outbox.push(Urgency::kBulk, datagram(3), kOpened);
  flushed(outbox, kOpened, 100ms);
  for (int i = 0; i < 7; ++i) outbox.push(Urgency::kState, datagram(2), kOpened + 100ms);
  CHECK(flushed(outbox, kOpened + 100ms, 1ns) == std::vector<int>(7, 2));
}

TEST_CASE("A line sends no more than its rate and one burst over any time") {
  std::mt19937 dice(5);
  const double rate = GENERATE(64e3, 1e6, 2e7);
  Outbox outbox(rate);
  std::vector<std::pair<double, double>> sent;  // s, bits with headers
  for (int i = 0; i < 2000; ++i) {
    const HostTime t = kOpened + i * 2ms;
    for (auto n = dice() % 8; n > 0; --n)
      outbox.push(static_cast<Urgency>(dice() % 3), datagram(1, 40 + dice() % 1400), t);
    outbox.flush(t, [&](std::span<const std::uint8_t> d) {
      sent.emplace_back(i * 2e-3, 8.0 * static_cast<double>(d.size() + Outbox::kHeaders));
      return true;
    });
  }
  REQUIRE(sent.size() > 50);
  for (std::size_t begin = 0; begin < sent.size(); begin += 37) {
    double bits = 0;
    for (std::size_t i = begin; i < sent.size(); ++i) {
      bits += sent[i].second;
      REQUIRE(bits <= 8 * Outbox::kBurstBytes + rate * (sent[i].first - sent[begin].first) + 1);
    }
  }
}

TEST_CASE("The number of bytes in an outbox is bounded") {
  Outbox outbox(16e3);
  for (int i = 0; i < 5000; ++i) outbox.push(Urgency::kFirst, datagram(1), kOpened);
  CHECK(outbox.counts().late >= 5000 - static_cast<std::int64_t>(Outbox::kMaxBytes / 1000));
}

TEST_CASE("A message that the network rejects is counted and not sent again") {
  Outbox outbox(0);
  outbox.push(Urgency::kFirst, datagram(1), kOpened);
  outbox.flush(kOpened, [](auto) { return false; });
  CHECK(outbox.counts().refused == 1);
  CHECK(flushed(outbox, kOpened, 10ms).empty());
}
