// Tests of the receiving end of the bus on real sockets, in a network namespace of its own.
#include "sync/bus/udp_reader.h"

#include <catch2/catch.hpp>
#include <map>
#include <thread>

#include "sync/clocks/pacing.h"
#include "tests/cluster/support/datagram.h"
#include "tests/cluster/support/two_machines.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

using ReceivedMessages = std::map<std::pair<std::size_t, std::string>, std::vector<Bytes>>;

// Reads for the given time, or until `enough` messages have arrived.
ReceivedMessages read(sync::UdpReader& reader, double seconds, std::size_t enough) {
  ReceivedMessages received;
  std::size_t count = 0;
  const auto end = sync::host_now() + sync::from_seconds(seconds);
  for (auto now = sync::host_now(); now < end && count < enough; now = sync::host_now()) {
    reader.wait(end - now);
    reader.read(100000, [&](std::size_t side, const sync::ChannelBytes& m) {
      received[{side, std::string(m.channel)}].emplace_back(m.data.begin(), m.data.end());
      ++count;
    });
  }
  return received;
}

Bytes numbered(int i, std::size_t size = 300) {
  Bytes bytes(size);
  for (int k = 0; k < 4; ++k) bytes[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(i >> (8 * k));
  return bytes;
}

}  // namespace

TEST_CASE("Messages of both ports are read in order, also those that arrived between reads", "[smoke]") {
  sync::UdpReader reader(channels::kGroup, channels::kDefaultPort);
  Datagrams wire;
  constexpr int kCount = 4000;
  for (int i = 0; i < kCount; ++i) {
    wire.send_message("A", numbered(i));
    wire.send_message("B", numbered(i), 1);
    if (i % 100 == 99)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));  // 0.2 s in all: the reader's thread must drain the sockets meanwhile
  }
  const ReceivedMessages received = read(reader, 10, 2 * kCount);
  for (const auto& key : {std::pair<std::size_t, std::string>{0, "A"}, {1, "B"}}) {
    REQUIRE(received.contains(key));
    const auto& messages = received.at(key);
    REQUIRE(messages.size() == kCount);
    for (int i = 0; i < kCount; ++i) REQUIRE(messages[static_cast<std::size_t>(i)] == numbered(i));
  }
  CHECK(received.size() == 2);
}

TEST_CASE("A waiting reader wakes when a message arrives, and reads at most the requested number") {
  sync::UdpReader reader(channels::kGroup, channels::kDefaultPort);
  Datagrams wire;
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    for (int i = 0; i < 10; ++i) wire.send_message("A", numbered(i));
  });
  const auto begin = sync::host_now();
  reader.wait(std::chrono::seconds(60));
  CHECK(sync::host_now() - begin < std::chrono::seconds(30));
  later.join();
  int count = 0;
  const auto on_message = [&](std::size_t, const sync::ChannelBytes& m) {
    CHECK(Bytes(m.data.begin(), m.data.end()) == numbered(count));
    ++count;
  };
  // On a busy machine the helper thread of the reader holds the messages for a while.
  const auto read_up_to = [&](int wanted) {
    while (count < wanted && sync::host_now() - begin < std::chrono::seconds(30)) reader.read(wanted - count, on_message);
    CHECK(count == wanted);
  };
  read_up_to(3);
  read_up_to(10);
}

TEST_CASE("Oversized messages, whole or in fragments, are reported as oversized, and noise is ignored") {
  sync::UdpReader reader(channels::kGroup, channels::kDefaultPort);
  Datagrams wire;
  wire.send_message("LONG", Bytes(50000));
  wire.send(
      {'L', 'C', '0', '3', 0, 0, 0, 1, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xf0, 0, 0, 0, 2, 'F', 0, 1, 2});
  wire.send(Bytes(100, 'x'));
  wire.send({});
  wire.send_message("LAST", Bytes(1400));
  std::map<std::string, bool> fits;
  for (int tries = 0; !fits.contains("LAST") && tries < 100; ++tries) {
    reader.wait(std::chrono::milliseconds(100));
    reader.read(100, [&](std::size_t, const sync::ChannelBytes& m) { fits[std::string(m.channel)] = m.fits(); });
  }
  CHECK(fits == std::map<std::string, bool>{{"LONG", false}, {"F", false}, {"LAST", true}});
}

TEST_CASE("Messages of another multicast group on the same port are not received") {
  sync::UdpReader reader(channels::kGroup, channels::kDefaultPort);
  sync::UdpReader other("239.255.76.68", channels::kDefaultPort);
  Datagrams wire;
  wire.send_message("A", numbered(1));
  CHECK(read(reader, 10, 1).size() == 1);
  CHECK(read(other, 0.1, 1).empty());
}

TEST_CASE("Messages from another network interface, where another program joined the group, are not received") {
  const Cable cable;
  if (!cable.is_ready()) {
    WARN("skipped: this system does not allow a second network namespace with a cable");
    return;
  }
  sync::UdpReader reader(channels::kGroup, channels::kDefaultPort);  // on the cable, according to the route
  const int other = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  const int yes = 1;
  setsockopt(other, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in any{};
  any.sin_family = AF_INET, any.sin_port = htons(channels::kDefaultPort);
  REQUIRE(bind(other, reinterpret_cast<const sockaddr*>(&any), sizeof any) == 0);
  ip_mreq member{};
  inet_pton(AF_INET, channels::kGroup, &member.imr_multiaddr);
  member.imr_interface.s_addr = htonl(INADDR_LOOPBACK);
  REQUIRE(setsockopt(other, IPPROTO_IP, IP_ADD_MEMBERSHIP, &member, sizeof member) == 0);
  Datagrams wire;
  wire.by_loopback();
  wire.send_message("A", numbered(1));
  CHECK(read(reader, 0.2, 1).empty());
  char byte = 0;
  CHECK(recv(other, &byte, sizeof byte, 0) == 1);  // the datagram did arrive at the machine
  close(other);
}
