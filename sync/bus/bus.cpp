#include "sync/bus/bus.h"

#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>
#include <system_error>
#include <tactus/clock_map_t.hpp>
#include <tactus/header_t.hpp>

#include "sync/bus/udp_reader.h"
#include "sync/virtual_time/virtual_time.h"

namespace tactus::sync {
namespace {

// Size of LCM's own queues, which a bus in memory uses. LCM drops the newest message when a queue is full, so it must not
// fill.
constexpr int kLcmQueue = 20000;
// Time limit of the self test. Multicast returns to its sender immediately, unless a firewall blocks it.
constexpr Nanoseconds kSelfTest = std::chrono::seconds(2);
constexpr const char* kSelfTestChannel = "LCM_SELF_TEST";  // LCM's own channel: stock tools recognise it

// Captures stderr during its lifetime. LCM prints long explanations to stderr when it cannot start; one sentence of this
// library replaces them.
class CapturedStderr {
 public:
  CapturedStderr() : kept_(dup(STDERR_FILENO)), file_(memfd_create("stderr", MFD_CLOEXEC)) {
    if (kept_ >= 0 && file_ >= 0) dup2(file_, STDERR_FILENO);
  }
  ~CapturedStderr() {
    if (kept_ >= 0 && file_ >= 0) dup2(kept_, STDERR_FILENO);
    if (kept_ >= 0) close(kept_);
    if (file_ >= 0) close(file_);
  }
  CapturedStderr(const CapturedStderr&) = delete;
  CapturedStderr& operator=(const CapturedStderr&) = delete;

  std::string text() const {
    char buffer[4096];
    const ssize_t size = pread(file_, buffer, sizeof buffer, 0);
    return size > 0 ? std::string(buffer, static_cast<std::size_t>(size)) : std::string();
  }

 private:
  int kept_, file_;
};

// Below SenderClock::kTolerance, above the time that reading a batch takes.
constexpr Nanoseconds kMaxStaleness{500'000};

std::string cannot_join(const Identity& id, const std::string& url) {
  return id.node + ": cannot join the bus at " + url + ": ";
}

// Opens a connection for sending. LCM binds no port for that and starts no thread.
std::shared_ptr<lcm::LCM> open(const std::string& url, const Identity& id) {
  const CapturedStderr captured;
  auto connection = std::make_shared<lcm::LCM>(url);
  if (connection->good()) return connection;
  throw std::runtime_error(
      cannot_join(id, url) +
      "there is no multicast route; start it with scripts/run, or add one: " + "ip route add 224.0.0.0/4 dev lo");
}

std::unique_ptr<UdpReader> open_reader(const Identity& id, const BusOptions& options) try {
  return std::make_unique<UdpReader>(options.group, options.port);
} catch (const std::system_error& e) {
  if (e.code().value() == EADDRINUSE)
    throw std::runtime_error(
        cannot_join(id, lcm_url(options, options.port)) + "port " + std::to_string(options.port) +
        " or the next is held by a program that does not share it; choose another --port, and " +
        "keep the next port free too");
  throw std::runtime_error(cannot_join(id, lcm_url(options, options.port)) + e.what());
}

}  // namespace

struct Bus::Connections {
  std::shared_ptr<lcm::LCM> realtime;
  std::shared_ptr<lcm::LCM> bulk;
  std::unique_ptr<UdpReader> reader;  // null in memory: LCM delivers the messages there
  std::unique_ptr<VirtualEnd> end;    // in virtual time: replaces all of them
  HostTime now{};                     // arrival time of the messages that are being drained

  struct Handler {
    Connections* connections;
    InboxBase* inbox;
    // A plain function: GCC 12 with -fsanitize=undefined,address checks a pointer that it has not set where LCM calls a member function.
    static void handle(const lcm::ReceiveBuffer* buffer, const std::string&, Handler* self) {
      self->inbox->accept(buffer->data, buffer->data_size, self->connections->now);
    }
  };
  std::vector<std::unique_ptr<Handler>> handlers;
  using Subscribers = std::map<std::string, std::vector<InboxBase*>, std::less<>>;
  std::array<Subscribers, 2> subscribers;  // of each port

  void on_message(std::size_t side, const ChannelBytes& m) {
    const auto at = subscribers[side].find(m.channel);
    if (at == subscribers[side].end()) return;
    // A fragment of a long message is passed on as too long.
    const std::size_t size = m.complete ? m.data.size() : channels::kMaxMessageBytes + 1;
    for (InboxBase* inbox : at->second) inbox->accept(m.data.data(), size, now);
  }
};

std::string lcm_url(const BusOptions& o, int port) {
  if (o.memory) return "memq://";
  return "udpm://" + o.group + ":" + std::to_string(port) + "?ttl=" + std::to_string(o.ttl);
}

Bus::Bus(Identity identity, const BusOptions& options)
    : identity_(std::move(identity)), maps_(identity_.run_id), connections_(std::make_unique<Connections>()) {
  if (options.clock != 0) identity_.clock = options.clock;
  Connections& c = *connections_;
  if (VirtualTime* time = VirtualTime::current()) {
    c.end = time->wire().join();
    return;
  }
  c.realtime = c.bulk = open(lcm_url(options, options.port), identity_);
  if (options.memory) return;
  c.bulk = open(lcm_url(options, options.port + 1), identity_);
  c.reader = open_reader(identity_, options);
  test_self(lcm_url(options, options.port));
}

void Bus::test_self(const std::string& url) {
  Connections& c = *connections_;
  const std::string token = std::to_string(identity_.incarnation);
  std::array<bool, 2> received{};
  for (const HostTime end = host_now() + kSelfTest; !(received[0] && received[1]);) {
    if (host_now() > end)
      throw std::runtime_error(
          cannot_join(identity_, url) +
          "messages sent there do not return; let the firewall pass UDP to its group, also "
          "from this machine to itself");
    for (lcm::LCM* port : {c.realtime.get(), c.bulk.get()})
      port->publish(kSelfTestChannel, token.data(), static_cast<unsigned>(token.size()));
    c.reader->wait(kSelfTest / 20);
    c.reader->read(kMaxDrain, [&](std::size_t side, const ChannelBytes& m) {
      if (m.channel == kSelfTestChannel && std::equal(m.data.begin(), m.data.end(), token.begin(), token.end()))
        received[side] = true;
    });
  }
}

Bus::~Bus() = default;

void Bus::subscribe(const char* channel, InboxBase* inbox, Port port) {
  Connections& c = *connections_;
  if (c.end) {
    if (port != Port::kBulk) c.end->subscribe(0, channel, inbox);
    if (port != Port::kRealtime) c.end->subscribe(1, channel, inbox);
    return;
  }
  if (!c.reader) {
    auto handler = std::make_unique<Connections::Handler>(Connections::Handler{&c, inbox});
    c.realtime->subscribeFunction(channel, &Connections::Handler::handle, handler.get())->setQueueCapacity(kLcmQueue);
    c.handlers.push_back(std::move(handler));
    return;
  }
  if (port != Port::kBulk) c.subscribers[0][channel].push_back(inbox);
  if (port != Port::kRealtime) c.subscribers[1][channel].push_back(inbox);
}

namespace {
// Stores clock maps where they are looked up, instead of in a queue.
class MapInbox : public InboxBase {
 public:
  explicit MapInbox(ClockMaps& maps) : InboxBase(channels::kClockMap), maps_(maps) {}
  void accept(const void* data, std::size_t size, HostTime arrival) noexcept override {
    if (const auto m = decode<clock_map_t>(data, size))
      maps_.observe(*m, arrival);
    else
      ++count_.bad;
  }

 private:
  ClockMaps& maps_;
};
}  // namespace

void Bus::track_clocks() {
  map_inbox_ = std::make_unique<MapInbox>(maps_);
  subscribe(channels::kClockMap, map_inbox_.get(), Port::kRealtime);
}

void Bus::drain(HostTime now) {
  Connections& c = *connections_;
  if (c.end) return c.end->drain(now, kMaxDrain);
  c.now = now;
  if (c.reader) {
    const auto on_message = [&](std::size_t side, const ChannelBytes& m) {
      // The loop was held up since `now` was read: a newer arrival time keeps messages from appearing to arrive before they
      // were sent.
      if (const HostTime later = host_now(); later - c.now > kMaxStaleness) c.now = later;
      c.on_message(side, m);
    };
    return c.reader->read(kMaxDrain, on_message);
  }
  int left = kMaxDrain;
  while (left > 0 && c.realtime->handleTimeout(0) > 0) --left;
}

void Bus::on_message(std::string_view channel, std::span<const std::uint8_t> data, HostTime arrival) {
  const auto deliver = [&](InboxBase& inbox) {
    if (inbox.count().channel == channel) inbox.accept(data.data(), data.size(), arrival);
  };
  for (const auto& inbox : inboxes_) deliver(*inbox);
  if (map_inbox_) deliver(*map_inbox_);
}

void Bus::wait(Nanoseconds max_wait) {
  if (connections_->end) return VirtualTime::current()->wait(*connections_->end, max_wait);
  if (connections_->reader) return connections_->reader->wait(max_wait);
  pollfd fd{connections_->realtime->getFileno(), POLLIN, 0};
  const std::int64_t ns = max_wait.count();
  const timespec timeout{ns / 1'000'000'000, ns % 1'000'000'000};
  ppoll(&fd, 1, &timeout, nullptr);
}

void Bus::begin_incarnation() {
  identity_.incarnation = Identity::fresh(identity_.node, identity_.run_id).incarnation;
  next_seq_.clear();
}

void Bus::stamp(const char* channel, header_t& h) {
  h.run_id = identity_.run_id;
  h.clock = identity_.clock;
  h.source = identity_.source;
  h.incarnation = identity_.incarnation;
  h.seq = next_seq_[channel]++;
  h.publish_time_ns = to_ns(host_now());
}

bool Bus::send(const char* channel, const void* data, unsigned size, Port port) {
  if (connections_->end) {
    VirtualTime& time = *VirtualTime::current();
    const std::span bytes(static_cast<const std::uint8_t*>(data), size);
    if (port != Port::kBulk) time.wire().send(*connections_->end, 0, channel, bytes, time.now());
    if (port != Port::kRealtime) time.wire().send(*connections_->end, 1, channel, bytes, time.now());
    return true;
  }
  bool sent = true;
  if (port != Port::kBulk) sent = connections_->realtime->publish(channel, data, size) == 0;
  if (port == Port::kBulk || (port == Port::kBoth && connections_->bulk != connections_->realtime))
    sent = connections_->bulk->publish(channel, data, size) == 0 && sent;
  return sent || refuse();
}

}  // namespace tactus::sync
