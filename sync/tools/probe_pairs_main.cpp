// probe_pairs: measures the network between hosts. One runs on each host, started at about the same time; each reports the
// datagrams that it receives from the others.
//
//   in, out  datagrams of its own (sync/clock_sync/pair_probe.h) to the group, on a port beside the bus
//
// Used by tactus cluster doctor. Prints one JSON object and ends, also when other hosts do not answer.
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iostream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "sync/bus/bus_arguments.h"
#include "sync/bus/receive_buffer.h"
#include "sync/node/node_options.h"
#include "sync/clocks/pacing.h"
#include "sync/clock_sync/pair_probe.h"

using namespace tactus;

namespace {

constexpr sync::Nanoseconds kPeriod{20'000'000};  // of requests, short and long alternately
constexpr std::uint64_t kBurst = 100;             // datagrams of a burst, as fast as possible
constexpr int kBursts = 3;
constexpr int kEnds = 5;
constexpr sync::Nanoseconds kLead{500'000'000};  // the other hosts start at about the same time, no better

class Socket {
 public:
  explicit Socket(const sync::BusOptions& o) : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const int on = 1;
    const auto ttl = static_cast<unsigned char>(o.ttl);
    to_.sin_family = AF_INET;
    to_.sin_port = htons(static_cast<std::uint16_t>(o.port));
    if (inet_pton(AF_INET, o.group.c_str(), &to_.sin_addr) != 1) throw std::runtime_error("--group " + o.group + ": is not an address");
    setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    sync::request_receive_buffer(fd_);
    sync::drop_receive_buffer_right();
    setsockopt(fd_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
    setsockopt(fd_, IPPROTO_IP, IP_RECVTTL, &on, sizeof on);
    ip_mreq member{};
    member.imr_multiaddr = to_.sin_addr;
    if (bind(fd_, reinterpret_cast<const sockaddr*>(&to_), sizeof to_) < 0 ||
        setsockopt(fd_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &member, sizeof member) < 0)
      throw std::system_error(errno, std::generic_category(),
                              "cannot join " + o.group + ", port " + std::to_string(o.port) +
                                  "; add a multicast route, ip route add 224.0.0.0/4 dev INTERFACE, or choose another --port");
  }
  ~Socket() { close(fd_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  bool send(const sync::PairDatagram& m, std::size_t size) {
    const auto bytes = m.encode(size);
    return sendto(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&to_), sizeof to_) ==
           static_cast<ssize_t>(bytes.size());
  }
  // Calls take(datagram, ttl, at) for all datagrams that arrive until then.
  template <class Take>
  void listen(sync::HostTime until, Take&& process) {
    for (sync::HostTime now = sync::host_now(); now < until; now = sync::host_now()) {
      pollfd p{fd_, POLLIN, 0};
      const std::int64_t left = (until - now).count();
      const timespec timeout{left / 1'000'000'000, left % 1'000'000'000};
      if (ppoll(&p, 1, &timeout, nullptr) <= 0) continue;
      std::uint8_t bytes[sync::PairDatagram::kMaxBytes + 1];
      alignas(cmsghdr) char control[64];
      iovec data{bytes, sizeof bytes};
      msghdr message{};
      message.msg_iov = &data;
      message.msg_iovlen = 1;
      message.msg_control = control;
      message.msg_controllen = sizeof control;
      const ssize_t size = recvmsg(fd_, &message, MSG_DONTWAIT);
      const sync::HostTime at = sync::host_now();
      if (size <= 0) continue;
      int ttl = -1;
      for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c))
        if (c->cmsg_level == IPPROTO_IP && c->cmsg_type == IP_TTL) std::memcpy(&ttl, CMSG_DATA(c), sizeof ttl);
      if (const auto m = sync::PairDatagram::decode({bytes, static_cast<std::size_t>(size)})) process(*m, ttl, at);
    }
  }
  int buffer_bytes() const {
    int given = 0;
    socklen_t size = sizeof given;
    getsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &given, &size);
    return given / 2;  // the kernel doubles the requested size
  }

 private:
  int fd_;
  sockaddr_in to_{};
};

double us(sync::Nanoseconds t) { return static_cast<double>(t.count()) * 1e-3; }

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app{"Measures the network to other hosts that run this program at the same time: reachability, losses, round trips and clock offsets."};
  sync::BusOptions bus;
  std::string host;
  std::vector<std::string> expected;
  std::uint64_t run = 0;
  double seconds = 5;
  sync::add_bus_options(app, bus);
  app.add_option("--host", host, "name of this host");
  app.add_option("--expect", expected, "names of all hosts, including this one").delimiter(',');
  app.add_option("--round", run, "number of this round of probes, the same on all hosts");
  app.add_option("--seconds", seconds, "how long").range(0.5, 600.0).show_default();
  sync::parse_or_exit(app, "probe_pairs", argc, argv);

  Socket socket(bus);
  if (host.empty() || expected.empty() || run == 0)
    throw std::invalid_argument("--host, --expect and --round are needed; see probe_pairs --help");
  std::map<std::string, sync::PairRecord> others;
  for (const std::string& name : expected)
    if (name != host) others[name];
  std::int64_t other_doctors = 0, refused = 0;
  const auto process = [&](const sync::PairDatagram& m, int ttl, sync::HostTime at) {
    if (m.run != run) {
      ++other_doctors;
      return;
    }
    const auto other = others.find(m.from);
    if (other == others.end()) return;  // this host
    if (m.kind == sync::PairDatagram::kReply) {
      if (m.to == host) other->second.on_reply(m, at);
      return;
    }
    other->second.on_message(m, ttl);
    if (m.kind != sync::PairDatagram::kRequest) return;
    sync::PairDatagram answer{run, sync::PairDatagram::kReply, m.number, host, m.from, m.sent_ns, sync::to_ns(at), 0};
    answer.replied_ns = sync::to_ns(sync::host_now());
    refused += !socket.send(answer, sync::PairDatagram::kMinBytes);
  };
  socket.listen(sync::host_now() + kLead, process);
  const sync::HostTime begin = sync::host_now(), end = begin + sync::from_seconds(seconds);
  // Bursts of different hosts at different times.
  const auto index = std::find(expected.begin(), expected.end(), host) - expected.begin();
  const double share = (1.0 + static_cast<double>(index)) / (2.0 + static_cast<double>(expected.size()));
  std::uint64_t asked = 0, burst = 0;
  for (sync::HostTime next = begin; next < end; next += kPeriod) {
    socket.listen(next, process);
    sync::PairDatagram m{run, sync::PairDatagram::kRequest, asked, host, "", 0, 0, 0};
    m.sent_ns = sync::to_ns(sync::host_now());
    refused += !socket.send(m, asked % 2 == 0 ? sync::PairDatagram::kMinBytes : sync::PairDatagram::kMaxBytes);
    ++asked;
    if (static_cast<int>(burst / kBurst) < kBursts &&
        sync::host_now() - begin > sync::from_seconds(seconds * (static_cast<double>(burst / kBurst) + share) / (kBursts + 1)))
      for (std::uint64_t i = 0; i < kBurst; ++i, ++burst)
        refused += !socket.send({run, sync::PairDatagram::kBurst, burst, host, "", 0, 0, 0}, sync::PairDatagram::kMaxBytes);
  }
  for (int i = 0; i < kEnds; ++i) {
    socket.send({run, sync::PairDatagram::kEnd, asked, host, "", 0, 0, 0}, sync::PairDatagram::kMinBytes);
    socket.listen(sync::host_now() + kPeriod * 5, process);
  }

  nlohmann::json result{{"host", host}, {"asked", asked}, {"burst", burst}, {"refused", refused}, {"other_doctors", other_doctors},
                      {"ttl", bus.ttl}, {"buffer_bytes", socket.buffer_bytes()}, {"others", nlohmann::json::object()}};
  for (const auto& [name, r] : others) {
    nlohmann::json& o = result["others"][name] = {{"received", r.received()}, {"answered", r.replied()}, {"lost", r.lost()},
                                                {"of_bursts", r.burst_datagrams()}, {"ttl", r.ttl()}};
    if (r.replied())
      o.update({{"round_trip_us", {{"least", us(r.round_trip(0))}, {"p50", us(r.round_trip(0.5))}, {"p99", us(r.round_trip(0.99))}}},
                {"offset_us", us(r.offset())}, {"uncertainty_us", us(r.uncertainty())}});
  }
  std::cout << result << std::endl;
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("probe_pairs", e);
}
