#include "sync/relay/link.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>

#include "sync/bus/receive_buffer.h"

namespace tactus::sync {
namespace {

constexpr std::string_view kMagic = "TRL1";
constexpr std::size_t kChannelAt = kMagic.size() + 1;  // after the port
// The limit of an unfragmented datagram on an Ethernet, plus a margin.
static_assert(kChannelAt + kMaxChannelBytes + 1 + channels::kMaxMessageBytes <= 2047);

std::optional<double> number(std::string_view text, double least, double most) {
  double x = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (error != std::errc{} || end != text.data() + text.size() || !(x >= least && x <= most)) return std::nullopt;
  return x;
}

}  // namespace

LineEnd parse_line_end(const std::string& text) {
  LineEnd end;
  end.name = text;
  end.address.sin_family = AF_INET;
  end.address.sin_addr.s_addr = htonl(INADDR_ANY);
  const std::size_t colon = text.rfind(':');
  const std::string address = colon == std::string::npos ? "" : text.substr(0, colon);
  const auto port = number(std::string_view(text).substr(colon == std::string::npos ? 0 : colon + 1), 1, 65535);
  if (!port || *port != static_cast<double>(static_cast<int>(*port)) ||
      (colon != std::string::npos && inet_pton(AF_INET, address.c_str(), &end.address.sin_addr) != 1))
    throw std::invalid_argument("\"" + text +
                                "\" is not an address with a port; write ADDRESS:PORT, as in 192.0.2.7:7700");
  end.address.sin_port = htons(static_cast<std::uint16_t>(*port));
  return end;
}

LineEnd parse_other_site(const std::string& text) {
  const std::size_t comma = text.find(',');
  LineEnd end = parse_line_end(text.substr(0, comma));
  if (end.address.sin_addr.s_addr == htonl(INADDR_ANY))
    throw std::invalid_argument(
        "\"" + text + "\" lacks the address of the other site's relay; write ADDRESS:PORT, as in 192.0.2.7:7700");
  if (comma == std::string::npos) return end;
  const auto kbit = number(std::string_view(text).substr(comma + 1), 16, 1e7);
  if (!kbit)
    throw std::invalid_argument(
        "\"" + text + "\": give what the line carries in kbit/s, from 16 to 10000000, as in 192.0.2.7:7700,2000");
  end.bit_per_s = 1e3 * *kbit;
  return end;
}

std::vector<std::uint8_t> line_datagram(const ChannelBytes& m, bool bulk) {
  std::vector<std::uint8_t> bytes(kChannelAt + m.channel.size() + 1 + m.data.size());
  std::copy(kMagic.begin(), kMagic.end(), bytes.begin());
  bytes[kMagic.size()] = bulk ? 1 : 0;
  auto at = std::copy(m.channel.begin(), m.channel.end(), bytes.begin() + kChannelAt);
  *at++ = 0;
  std::copy(m.data.begin(), m.data.end(), at);
  return bytes;
}

std::optional<LineMessage> parse_line_datagram(std::span<const std::uint8_t> bytes) {
  if (bytes.size() <= kChannelAt || !std::equal(kMagic.begin(), kMagic.end(), bytes.begin()) ||
      bytes[kMagic.size()] > 1)
    return std::nullopt;
  const auto name = bytes.subspan(kChannelAt);
  const auto end = std::find(name.begin(), name.end(), std::uint8_t{0});
  const auto length = static_cast<std::size_t>(end - name.begin());
  if (end == name.end() || length == 0 || length > kMaxChannelBytes) return std::nullopt;
  const ChannelBytes message{{reinterpret_cast<const char*>(name.data()), length}, name.subspan(length + 1)};
  if (!message.fits()) return std::nullopt;
  return LineMessage{message, bytes[kMagic.size()] == 1};
}

LineSocket::LineSocket(const LineEnd& here)
    : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  if (socket_ >= 0) request_receive_buffer(socket_);
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&here.address), sizeof here.address) == 0) return;
  const std::string reason = std::strerror(errno);
  if (socket_ >= 0) close(socket_);
  throw std::runtime_error("cannot listen at " + here.name + " (" + reason +
                           "); choose another --listen, an address of this host with a free port");
}

LineSocket::~LineSocket() { close(socket_); }

bool LineSocket::send(const LineEnd& to, std::span<const std::uint8_t> datagram) {
  return sendto(socket_, datagram.data(), datagram.size(), MSG_DONTWAIT,
                reinterpret_cast<const sockaddr*>(&to.address),
                sizeof to.address) == static_cast<ssize_t>(datagram.size());
}

std::optional<LineSocket::Arrived> LineSocket::receive(std::span<const LineEnd> sites) {
  sockaddr_in from{};
  socklen_t length = sizeof from;
  const ssize_t size =
      recvfrom(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT, reinterpret_cast<sockaddr*>(&from), &length);
  if (size < 0) return std::nullopt;
  for (std::size_t i = 0; i < sites.size(); ++i)
    if (sites[i].address.sin_addr.s_addr == from.sin_addr.s_addr && sites[i].address.sin_port == from.sin_port)
      return Arrived{static_cast<int>(i), {buffer_.data(), static_cast<std::size_t>(size)}};
  return Arrived{-1, {}};
}

}  // namespace tactus::sync
