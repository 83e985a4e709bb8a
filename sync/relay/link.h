// The line between two relays: unicast UDP datagrams, each with a channel, its port of the bus, and the bytes of one message.
//
// Only the named relays are accepted, by their address, which an attacker on the line can forge. Lines that others can reach
// belong into a private network path (docs/between_sites.md).
#pragma once

#include <netinet/in.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sync/bus/datagram.h"

namespace tactus::sync {

// One end of a line. bit_per_s 0: unlimited.
struct LineEnd {
  sockaddr_in address{};
  double bit_per_s = 0;
  std::string name;  // as written by the user
};
// "ADDRESS:PORT" or "PORT". Throws std::invalid_argument with one sentence.
LineEnd parse_line_end(const std::string& text);
// "ADDRESS:PORT" or "ADDRESS:PORT,KBIT".
LineEnd parse_other_site(const std::string& text);

struct LineMessage {
  ChannelBytes message;
  bool bulk = false;
};
std::vector<std::uint8_t> line_datagram(const ChannelBytes& message, bool bulk);
// nullopt when the bytes are not such a datagram. Refers to `bytes`.
std::optional<LineMessage> parse_line_datagram(std::span<const std::uint8_t> bytes);

class LineSocket {
 public:
  // Throws std::runtime_error with one sentence.
  explicit LineSocket(const LineEnd& here);
  ~LineSocket();
  LineSocket(const LineSocket&) = delete;
  LineSocket& operator=(const LineSocket&) = delete;

  // Returns false when the network refused it. Never waits.
  bool send(const LineEnd& to, std::span<const std::uint8_t> datagram);
  // Calls on_message(index of the site, LineMessage) for the datagrams received from these sites, at most kMax, without waiting.
  template <class OnMessage>
  void read(std::span<const LineEnd> sites, OnMessage&& on_message) {
    for (int i = 0; i < kMax; ++i) {
      const auto arrived = receive(sites);
      if (!arrived) return;
      if (arrived->site < 0) continue;
      if (const auto m = parse_line_datagram(arrived->bytes))
        on_message(static_cast<std::size_t>(arrived->site), *m);
    }
  }

 private:
  static constexpr int kMax = 4096;
  struct Arrived {
    int site;  // -1: not a named site
    std::span<const std::uint8_t> bytes;
  };
  std::optional<Arrived> receive(std::span<const LineEnd> sites);

  int socket_;
  std::array<std::uint8_t, 2048> buffer_;
};

}  // namespace tactus::sync
