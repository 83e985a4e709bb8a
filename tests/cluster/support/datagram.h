// Sends arbitrary bytes on the bus, as an attacker or a faulty program would.
#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/channels.h"

namespace tactus::cluster {

using Bytes = std::vector<std::uint8_t>;

class Datagrams {
 public:
  Datagrams() : socket_(socket(AF_INET, SOCK_DGRAM, 0)) {
    const unsigned char ttl = 0;
    setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  }
  ~Datagrams() { close(socket_); }
  Datagrams(const Datagrams&) = delete;
  Datagrams& operator=(const Datagrams&) = delete;

  // Sends by the loopback interface from now on, regardless of the route to the group.
  void by_loopback() const {
    const in_addr loopback{htonl(INADDR_LOOPBACK)};
    setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback);
  }

  // Sends to the real-time port (0) or the bulk port (1). Datagrams that the network refuses are lost.
  void send(const Bytes& bytes, int port = 0) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(channels::kDefaultPort + port));
    inet_pton(AF_INET, channels::kGroup, &to.sin_addr);
    sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }
  // Sends one message in LCM's framing: magic number, sequence number, name of the channel, payload (LCM, "UDP Multicast Protocol
  // Description").
  void send_message(const std::string& channel, const Bytes& payload, int port = 0) {
    Bytes bytes{'L', 'C', '0', '2'};
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(sequence_ >> shift));
    ++sequence_;
    bytes.insert(bytes.end(), channel.begin(), channel.end());
    bytes.push_back(0);
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    send(bytes, port);
  }

 private:
  int socket_;
  std::uint32_t sequence_ = 0;
};

}  // namespace tactus::cluster
