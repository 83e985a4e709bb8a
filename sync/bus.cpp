#include "sync/bus.h"

#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

#include <lcm/lcm-cpp.hpp>
#include <stdexcept>

namespace tactus::sync {
namespace {

// 2 MB: a 20,000-datagram burst of 100 bytes, or one second of the page budget. Capped by net.core.rmem_max.
constexpr int kReceiveBufferBytes = 2 << 20;
// LCM drops the newest message when a subscription's queue is full, so it must not fill: one second of every channel.
constexpr int kLcmQueue = 20000;

// LCM explains to stderr, at length, why it cannot start; one sentence of ours is enough. Takes what is written to stderr
// while it lives.
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

std::shared_ptr<lcm::LCM> open(const std::string& url, const Identity& id, const BusOptions& options, int port) {
  const CapturedStderr lcm_says;
  auto connection = std::make_shared<lcm::LCM>(url);
  // getFileno makes LCM bind, start its reading thread and test itself now, not at the first message.
  if (connection->good() && (options.memory || connection->getFileno() >= 0)) return connection;
  const std::string where = id.node + ": cannot join the bus at " + url + ": ";
  if (lcm_says.text().find("in use") != std::string::npos)
    throw std::runtime_error(where + "port " + std::to_string(port) + " is held by a program that does not share it; " +
                             "choose another --port, and leave the one after it free too");
  throw std::runtime_error(where + "there is no multicast route; start it with scripts/run, or add one: " +
                           "ip route add 224.0.0.0/4 dev lo");
}

}  // namespace

struct Bus::Connections {
  std::shared_ptr<lcm::LCM> realtime;
  std::shared_ptr<lcm::LCM> bulk;
  HostTime now{};  // stamp for what is drained

  struct Handler {
    Connections* connections;
    InboxBase* inbox;
    void handle(const lcm::ReceiveBuffer* buffer, const std::string&) {
      inbox->accept(buffer->data, buffer->data_size, connections->now);
    }
  };
  std::vector<std::unique_ptr<Handler>> handlers;

  lcm::LCM& at(Port port) { return port == Port::kBulk ? *bulk : *realtime; }
};

std::string lcm_url(const BusOptions& o, int port) {
  if (o.memory) return "memq://";
  return "udpm://" + o.group + ":" + std::to_string(port) + "?ttl=" + std::to_string(o.ttl) +
         "&recv_buf_size=" + std::to_string(kReceiveBufferBytes);
}

Bus::Bus(Identity identity, const BusOptions& options)
    : identity_(std::move(identity)), maps_(identity_.run_id), connections_(std::make_unique<Connections>()) {
  connections_->realtime = open(lcm_url(options, options.port), identity_, options, options.port);
  connections_->bulk =
      options.memory ? connections_->realtime
                     : open(lcm_url(options, options.port + 1), identity_, options, options.port + 1);
}

Bus::~Bus() = default;

void Bus::subscribe(const char* channel, InboxBase* inbox, Port port) {
  auto handler = std::make_unique<Connections::Handler>(Connections::Handler{connections_.get(), inbox});
  const auto join = [&](lcm::LCM& connection) {
    connection.subscribe(channel, &Connections::Handler::handle, handler.get())->setQueueCapacity(kLcmQueue);
  };
  const bool one_connection = connections_->realtime == connections_->bulk;
  if (port != Port::kBulk) join(*connections_->realtime);
  if (port == Port::kBulk || (port == Port::kBoth && !one_connection)) join(*connections_->bulk);
  connections_->handlers.push_back(std::move(handler));
}

namespace {
// Stores what is known of clocks where it is looked up, not where it is taken out.
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

void Bus::follow_clocks() {
  map_inbox_ = std::make_unique<MapInbox>(maps_);
  subscribe(channels::kClockMap, map_inbox_.get(), Port::kRealtime);
}

void Bus::drain(HostTime now) {
  connections_->now = now;
  int left = kMaxDrain;
  while (left > 0 && connections_->realtime->handleTimeout(0) > 0) --left;
  if (connections_->bulk != connections_->realtime)
    while (left > 0 && connections_->bulk->handleTimeout(0) > 0) --left;
}

void Bus::wait(Nanoseconds at_most) {
  pollfd fds[2] = {{connections_->realtime->getFileno(), POLLIN, 0}, {connections_->bulk->getFileno(), POLLIN, 0}};
  const int count = connections_->bulk == connections_->realtime ? 1 : 2;
  const std::int64_t ns = at_most.count();
  const timespec timeout{ns / 1'000'000'000, ns % 1'000'000'000};
  ppoll(fds, static_cast<nfds_t>(count), &timeout, nullptr);
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
  bool sent = true;
  if (port != Port::kBulk) sent = connections_->realtime->publish(channel, data, size) == 0;
  if (port == Port::kBulk || (port == Port::kBoth && connections_->bulk != connections_->realtime))
    sent = connections_->bulk->publish(channel, data, size) == 0 && sent;
  return sent || refuse();
}

}  // namespace tactus::sync
