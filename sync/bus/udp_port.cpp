#include "sync/bus/udp_port.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "sync/bus/receive_buffer.h"

namespace tactus::sync {
namespace {

[[noreturn]] void fail(const char* action) { throw std::system_error(errno, std::generic_category(), action); }

void set(int socket, int level, int option, const void* value, socklen_t size, const char* action) {
  if (setsockopt(socket, level, option, value, size) < 0) fail(action);
}

void prepare(int socket, const std::string& group, int port) {
  const int yes = 1;
  set(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes, "SO_REUSEADDR");
  request_receive_buffer(socket);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, group.c_str(), &at.sin_addr) != 1) {
    errno = EINVAL;
    fail("group");
  }
  // Binds to the address of the group, so that other groups on this port are not received.
  if (bind(socket, reinterpret_cast<const sockaddr*>(&at), sizeof at) < 0) fail("bind");
  ip_mreq member{};
  member.imr_multiaddr = at.sin_addr;
  set(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, &member, sizeof member, "IP_ADD_MEMBERSHIP");
  // Receives the group on that interface only. By default a socket also receives groups that other programs joined on other
  // interfaces.
  const int no = 0;
  set(socket, IPPROTO_IP, IP_MULTICAST_ALL, &no, sizeof no, "IP_MULTICAST_ALL");
}

}  // namespace

UdpPort::UdpPort(const std::string& group, int port) : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  if (socket_ < 0) fail("socket");
  try {
    prepare(socket_, group, port);
  } catch (...) {
    close(socket_);
    throw;
  }
}

UdpPort::~UdpPort() { close(socket_); }

int UdpPort::receive(int requested) {
  std::array<iovec, kBatch> parts;
  std::array<mmsghdr, kBatch> messages{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(requested); ++i) {
    parts[i] = {buffers_[i].data(), kDatagramBytes};
    messages[i].msg_hdr.msg_iov = &parts[i];
    messages[i].msg_hdr.msg_iovlen = 1;
  }
  const int got = recvmmsg(socket_, messages.data(), static_cast<unsigned>(requested), MSG_DONTWAIT, nullptr);
  for (int i = 0; i < got; ++i)
    sizes_[static_cast<std::size_t>(i)] = messages[static_cast<std::size_t>(i)].msg_len;
  return std::max(got, 0);
}

}  // namespace tactus::sync
