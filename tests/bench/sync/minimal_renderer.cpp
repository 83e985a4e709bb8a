// A minimal subscriber with the bus load of a renderer. Sixty times per second it drains its queues, decodes the messages that a renderer
// needs, counts gaps, and measures the time from publish_time_ns to the kernel's arrival stamp. Started by tests/measure/measure_growth;
// prints one JSON object at its end.
#include <arpa/inet.h>
#include <signal.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/world_state_t.hpp>
#include <vector>

#include "sync/bus/bus_arguments.h"
#include "sync/bus/datagram.h"
#include "sync/bus/decode.h"
#include "sync/node/node_options.h"
#include "sync/clocks/pacing.h"

using namespace tactus;

namespace {

constexpr sync::Nanoseconds kTick{16'666'667};
constexpr int kBatch = 64;
constexpr int kBufferBytes = 4 << 20;  // as sync/bus/udp_port.cpp
std::atomic<bool> stop{false};

std::int64_t clock_ns(clockid_t id) {
  timespec t{};
  clock_gettime(id, &t);
  return t.tv_sec * 1'000'000'000 + t.tv_nsec;
}

class Subscriber {
 public:
  explicit Subscriber(const sync::BusOptions& o) : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const int on = 1;
    setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    setsockopt(fd_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
    setsockopt(fd_, SOL_SOCKET, SO_RCVBUFFORCE, &kBufferBytes, sizeof kBufferBytes);
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(static_cast<std::uint16_t>(o.port));
    inet_pton(AF_INET, o.group.c_str(), &at.sin_addr);
    ip_mreq member{};
    member.imr_multiaddr = at.sin_addr;
    if (bind(fd_, reinterpret_cast<const sockaddr*>(&at), sizeof at) < 0 ||
        setsockopt(fd_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &member, sizeof member) < 0)
      throw std::runtime_error("cannot join " + o.group + " (" + std::strerror(errno) + "); add a multicast route");
    for (std::size_t i = 0; i < kBatch; ++i) {
      parts_[i] = {bytes_[i].data(), bytes_[i].size()};
      messages_[i].msg_hdr.msg_iov = &parts_[i];
      messages_[i].msg_hdr.msg_iovlen = 1;
    }
  }
  ~Subscriber() { close(fd_); }

  void tick() {
    const std::int64_t ahead = clock_ns(CLOCK_REALTIME) - clock_ns(CLOCK_MONOTONIC);
    for (int got = kBatch; got == kBatch;) {
      for (std::size_t i = 0; i < kBatch; ++i) {
        messages_[i].msg_hdr.msg_control = control_[i].data();
        messages_[i].msg_hdr.msg_controllen = control_[i].size();
      }
      got = recvmmsg(fd_, messages_.data(), kBatch, MSG_DONTWAIT, nullptr);
      for (int i = 0; i < got; ++i) take(static_cast<std::size_t>(i), ahead);
    }
  }
  nlohmann::json statistics() {
    std::sort(latencies_us_.begin(), latencies_us_.end());
    const auto at = [&](double share) {
      return latencies_us_.empty() ? 0.0 : latencies_us_[static_cast<std::size_t>(share * double(latencies_us_.size() - 1))];
    };
    return {{"messages", received_}, {"lost", lost_}, {"bad", malformed_}, {"latency_us", {{"p50", at(0.5)}, {"p99", at(0.99)}, {"worst", at(1)}}}};
  }

 private:
  void take(std::size_t i, std::int64_t ahead) {
    const auto m = sync::parse_datagram({bytes_[i].data(), messages_[i].msg_len});
    if (!m || !m->complete) return;
    std::int64_t arrived = 0;
    for (cmsghdr* c = CMSG_FIRSTHDR(&messages_[i].msg_hdr); c != nullptr; c = CMSG_NXTHDR(&messages_[i].msg_hdr, c))
      if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SCM_TIMESTAMPNS) {
        timespec t{};
        std::memcpy(&t, CMSG_DATA(c), sizeof t);
        arrived = t.tv_sec * 1'000'000'000 + t.tv_nsec - ahead;
      }
    if (m->channel == channels::kContactEvents) on_message<contact_events_t>(*m, arrived);
    if (m->channel == channels::kWorldState) on_message<world_state_t>(*m, arrived);
    if (m->channel == channels::kTouchModel) on_message<touch_model_t>(*m, arrived);
  }
  template <class Message>
  void on_message(const sync::ChannelBytes& bytes, std::int64_t arrived) {
    const auto m = sync::decode<Message>(bytes.data.data(), bytes.data.size());
    if (!m) {
      ++malformed_;
      return;
    }
    ++received_;
    auto [next, inserted] = next_.try_emplace({std::string(bytes.channel), m->header.incarnation}, m->header.seq);
    if (!inserted && m->header.seq > next->second) lost_ += m->header.seq - next->second;
    next->second = m->header.seq + 1;
    latencies_us_.push_back(static_cast<double>(arrived - m->header.publish_time_ns) * 1e-3);
  }

  int fd_;
  std::array<std::array<std::uint8_t, 1600>, kBatch> bytes_;
  alignas(cmsghdr) std::array<std::array<std::uint8_t, 64>, kBatch> control_;
  std::array<iovec, kBatch> parts_;
  std::array<mmsghdr, kBatch> messages_{};
  std::map<std::pair<std::string, std::int64_t>, std::int64_t> next_;
  std::int64_t received_ = 0, lost_ = 0, malformed_ = 0;
  std::vector<double> latencies_us_;
};

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app{"Receives the bus like a renderer without rendering, and prints statistics of the received messages at its end."};
  sync::BusOptions bus;
  sync::add_bus_options(app, bus);
  sync::parse_or_exit(app, "minimal_renderer", argc, argv);
  for (int s : {SIGINT, SIGTERM}) signal(s, [](int) { stop = true; });
  Subscriber subscriber(bus);
  for (sync::HostTime next = sync::host_now(); !stop; next += kTick) {
    const std::int64_t ns = sync::to_ns(next);
    const timespec until{ns / 1'000'000'000, ns % 1'000'000'000};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    subscriber.tick();
  }
  std::cout << subscriber.statistics() << std::endl;
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("minimal_renderer", e);
}
