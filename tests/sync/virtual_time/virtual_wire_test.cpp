// Tests of the network in virtual time: latency, jitter and loss.
#include "sync/virtual_time/virtual_wire.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "sync/bus/inbox.h"

using namespace tactus::sync;
using namespace std::chrono_literals;

namespace {

constexpr HostTime kBegin{std::chrono::hours(1)};

// Stores the first byte of each message and its time.
class Ear : public InboxBase {
 public:
  using InboxBase::InboxBase;
  void accept(const void* data, std::size_t, HostTime arrival) noexcept override {
    heard.emplace_back(static_cast<const std::uint8_t*>(data)[0], arrival);
  }
  std::vector<std::pair<int, HostTime>> heard;
};

void send(VirtualWire& wire, const VirtualEnd& from, int what, HostTime at, const char* channel = "A", std::size_t side = 0) {
  const std::vector<std::uint8_t> bytes{static_cast<std::uint8_t>(what)};
  wire.send(from, side, channel, bytes, at);
}

}  // namespace

TEST_CASE("A message arrives after the latency at the subscribers of its channel and port") {
  VirtualWire wire({.latency = 3ms}, 1);
  const auto sender = wire.join(), receiver = wire.join();
  Ear a("A"), b("B"), bulk("A"), own("A");
  receiver->subscribe(0, "A", &a);
  receiver->subscribe(0, "B", &b);
  receiver->subscribe(1, "A", &bulk);
  sender->subscribe(0, "A", &own);
  CHECK(receiver->next_arrival() == HostTime::max());
  send(wire, *sender, 1, kBegin);
  CHECK(receiver->next_arrival() == kBegin + 3ms);
  receiver->drain(kBegin + 3ms - 1ns, 10);
  CHECK(a.heard.empty());
  receiver->drain(kBegin + 4ms, 10);
  CHECK(a.heard == std::vector<std::pair<int, HostTime>>{{1, kBegin + 4ms}});
  CHECK(b.heard.empty());
  CHECK(bulk.heard.empty());
  sender->drain(kBegin, 10);  // messages of a program to itself cross no wire
  CHECK(own.heard.size() == 1);
}

TEST_CASE("A blocked channel loses its messages until it is open again, and no other channel does") {
  VirtualWire wire({}, 1);
  const auto sender = wire.join(), receiver = wire.join();
  Ear a("A"), b("B");
  receiver->subscribe(0, "A", &a);
  receiver->subscribe(0, "B", &b);
  wire.block("A", kBegin + 3ms);
  for (int ms = 0; ms < 6; ++ms) {
    send(wire, *sender, ms, kBegin + ms * 1ms, "A");
    send(wire, *sender, ms, kBegin + ms * 1ms, "B");
  }
  receiver->drain(kBegin + 10ms, 100);
  CHECK(a.heard.size() == 3);
  CHECK(a.heard.front().first == 3);
  CHECK(b.heard.size() == 6);
}

TEST_CASE("Jitter keeps the order and never delivers before sending") {
  VirtualWire wire({.latency = 1ms, .jitter = {.shape = JitterShape::kNormal, .scale_s = 5e-3}}, 2);
  const auto sender = wire.join(), receiver = wire.join();
  Ear ear("A");
  receiver->subscribe(0, "A", &ear);
  constexpr int kSent = 200;
  for (auto t = 0us; t < 500ms; t += 100us) {
    if (t % 1ms == 0us && t < kSent * 1ms) send(wire, *sender, static_cast<int>(t / 1ms), kBegin + t);
    receiver->drain(kBegin + t, 1000);
  }
  REQUIRE(ear.heard.size() == kSent);
  int late = 0;
  for (int i = 0; i < kSent; ++i) {
    const auto& [what, at] = ear.heard[static_cast<std::size_t>(i)];
    CHECK(what == i);
    const Nanoseconds took = at - (kBegin + i * 1ms);
    CHECK(took >= 0ns);
    late += took > 1100us;
  }
  // Normal jitter of 5 ms about 1 ms without overtaking: far more than half are late.
  CHECK(late > kSent / 2);
}

TEST_CASE("Each receiver independently loses the specified share") {
  constexpr int kSent = 20000;
  VirtualWire wire({.loss = {.share = 0.1}}, 3);
  const auto sender = wire.join(), first = wire.join(), second = wire.join();
  Ear a("A"), b("A");
  first->subscribe(0, "A", &a);
  second->subscribe(0, "A", &b);
  std::vector<std::pair<bool, bool>> arrived;
  for (int i = 0; i < kSent; ++i) {
    const auto before_a = a.heard.size(), before_b = b.heard.size();
    send(wire, *sender, 0, kBegin);
    first->drain(kBegin, 10), second->drain(kBegin, 10);
    arrived.emplace_back(a.heard.size() > before_a, b.heard.size() > before_b);
  }
  // Five standard deviations of a binomial count.
  const double five = 5 * std::sqrt(kSent * 0.1 * 0.9);
  CHECK(std::abs(kSent * 0.9 - static_cast<double>(a.heard.size())) < five);
  CHECK(std::abs(kSent * 0.9 - static_cast<double>(b.heard.size())) < five);
  const auto both = std::count(arrived.begin(), arrived.end(), std::pair{false, false});
  CHECK(std::abs(kSent * 0.01 - static_cast<double>(both)) < 5 * std::sqrt(kSent * 0.01));
  CHECK(wire.sent() == kSent);
}

TEST_CASE("Messages are delivered in batches, oldest first, and not to removed receivers") {
  VirtualWire wire({}, 4);
  const auto sender = wire.join();
  auto receiver = wire.join();
  Ear ear("A");
  receiver->subscribe(0, "A", &ear);
  for (int i = 0; i < 10; ++i) send(wire, *sender, i, kBegin);
  receiver->drain(kBegin, 4);
  REQUIRE(ear.heard.size() == 4);
  CHECK(ear.heard.back().first == 3);
  CHECK(receiver->next_arrival() == kBegin);
  receiver.reset();
  send(wire, *sender, 11, kBegin);
  CHECK(ear.heard.size() == 4);
}

TEST_CASE("A recorder receives all sent messages, and an impossible loss is rejected") {
  VirtualWire wire({.loss = {.share = 1}}, 5);
  const auto sender = wire.join();
  int received = 0;
  wire.add_listener([&](HostTime at, std::string_view channel, std::span<const std::uint8_t> data) {
    received += at == kBegin && channel == "A" && data.size() == 1;
  });
  send(wire, *sender, 1, kBegin);
  CHECK(received == 1);
  CHECK_THROWS_AS(VirtualWire({.loss = {.share = 0.9, .mean_burst = 2}}, 1), std::invalid_argument);
}
