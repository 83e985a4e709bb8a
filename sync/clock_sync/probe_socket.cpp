#include "sync/clock_sync/probe_socket.h"

#include <arpa/inet.h>
#include <linux/filter.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include "sync/bus/decode.h"
#include "sync/clocks/pacing.h"

namespace tactus::sync {
namespace {

constexpr std::uint32_t kLcmMagic = 0x4c433032;  // "LC02", a message in one datagram
constexpr std::size_t kChannelBytes = 12;     // "CLOCK_PROBE" and its zero
constexpr std::size_t kPrefix = 8 + kChannelBytes;
// Maximum age of a kernel stamp. An older one is not used, and the arrival then counts as later than it was.
constexpr Nanoseconds kOldest{100'000'000};
// Reading one clock after the other takes less than this unless the thread was interrupted or the clock was set.
constexpr Nanoseconds kSteady{50'000};

// Makes the kernel drop all other channels: the channel name follows 8 bytes of UDP and 8 of LCM.
void attach_filter(int fd) {
  const auto word = [](const char* s) {
    std::uint32_t w = 0;
    std::memcpy(&w, s, 4);
    return ntohl(w);
  };
  const char* name = channels::kClockProbe;
  sock_filter code[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, 8),  BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kLcmMagic, 0, 7),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, 16), BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, word(name), 0, 5),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, 20), BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, word(name + 4), 0, 3),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, 24), BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, word(name + 8), 0, 1),
      BPF_STMT(BPF_RET | BPF_K, 0xffff),      BPF_STMT(BPF_RET | BPF_K, 0)};
  const sock_fprog program{sizeof code / sizeof code[0], code};
  // The filter is optional: without it the thread only wakes more often.
  setsockopt(fd, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program);
}

std::runtime_error socket_error(const BusOptions& o, const char* action) {
  return std::runtime_error(std::string("cannot ") + action + " for clock probes at " + o.group + ":" + std::to_string(o.port) +
                            " (" + std::strerror(errno) + "); choose another --port");
}

}  // namespace

ProbeSocket::ProbeSocket(const BusOptions& o) : port_(htons(static_cast<std::uint16_t>(o.port))) {
  static_assert(kChannelBytes == 12);
  socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  wake_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (socket_ < 0 || wake_ < 0) throw socket_error(o, "open a socket");
  attach_filter(socket_);  // before any datagram can arrive
  const int on = 1;
  const auto ttl = static_cast<unsigned char>(o.ttl);
  setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  setsockopt(socket_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_port = port_;
  inet_pton(AF_INET, o.group.c_str(), &here.sin_addr);
  address_ = here.sin_addr.s_addr;
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0) throw socket_error(o, "bind a socket");
  ip_mreq group{};
  group.imr_multiaddr.s_addr = address_;
  if (setsockopt(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group) != 0) throw socket_error(o, "join the group");
  const int no = 0;  // on the interface of the route only, as sync/bus/udp_port.cpp
  if (setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_ALL, &no, sizeof no) != 0) throw socket_error(o, "join the group on one interface");
}

ProbeSocket::~ProbeSocket() {
  close(socket_);
  close(wake_);
}

void ProbeSocket::wake() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = write(wake_, &one, sizeof one);
}

std::optional<ProbeSocket::Received> ProbeSocket::receive(HostTime until) {
  for (;;) {
    if (const auto probe = read_one()) return probe;
    const Nanoseconds left = until - host_now();
    if (left <= Nanoseconds(0)) return std::nullopt;
    pollfd fds[2] = {{socket_, POLLIN, 0}, {wake_, POLLIN, 0}};
    const timespec timeout{left.count() / 1'000'000'000, left.count() % 1'000'000'000};
    if (ppoll(fds, 2, &timeout, nullptr) < 0 || fds[1].revents != 0) return std::nullopt;
  }
}

std::optional<ProbeSocket::Received> ProbeSocket::read_one() {
  std::uint8_t bytes[2048];
  alignas(cmsghdr) char control[128];
  for (;;) {
    iovec data{bytes, sizeof bytes};
    msghdr message{};
    message.msg_iov = &data, message.msg_iovlen = 1;
    message.msg_control = control, message.msg_controllen = sizeof control;
    const ssize_t size = recvmsg(socket_, &message, 0);
    if (size < 0) return std::nullopt;
    timespec real{};
    clock_gettime(CLOCK_REALTIME, &real);
    HostTime at = host_now();
    const Nanoseconds realtime(real.tv_sec * 1'000'000'000 + real.tv_nsec);
    const Nanoseconds ahead = realtime - at.time_since_epoch();
    const Nanoseconds moved = ahead - realtime_minus_monotonic_;
    realtime_minus_monotonic_ = ahead;
    for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
      if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_TIMESTAMPNS) continue;
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
      const Nanoseconds age = realtime - Nanoseconds(stamp.tv_sec * 1'000'000'000 + stamp.tv_nsec);
      if (age > Nanoseconds(0) && age < kOldest && moved < kSteady && moved > -kSteady) at -= age;
    }
    const auto length = static_cast<std::size_t>(size);
    std::uint32_t magic = 0;
    if (length >= kPrefix) std::memcpy(&magic, bytes, sizeof magic);
    if (ntohl(magic) != kLcmMagic || std::memcmp(bytes + 8, channels::kClockProbe, kChannelBytes) != 0) continue;
    if (const auto probe = decode<clock_probe_t>(bytes + kPrefix, length - kPrefix)) return Received{*probe, at};
  }
}

bool ProbeSocket::send(const clock_probe_t& probe) {
  std::uint8_t bytes[512];
  const std::uint32_t head[2] = {htonl(kLcmMagic), htonl(next_number_++)};
  std::memcpy(bytes, head, sizeof head);
  std::memcpy(bytes + 8, channels::kClockProbe, kChannelBytes);
  const int size = probe.encode(bytes + kPrefix, 0, static_cast<int>(sizeof bytes - kPrefix));
  if (size < 0) return false;
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = port_;
  to.sin_addr.s_addr = address_;
  const std::size_t length = kPrefix + static_cast<std::size_t>(size);
  return sendto(socket_, bytes, length, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to) == static_cast<ssize_t>(length);
}

}  // namespace tactus::sync
