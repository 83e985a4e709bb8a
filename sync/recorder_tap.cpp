#include "sync/recorder_tap.h"

#include <poll.h>

#include <lcm/lcm-cpp.hpp>
#include <stdexcept>

#include "sync/pacing.h"

namespace tactus::sync {
namespace {

// Both are needed (measured: either alone loses 20,000 messages in a burst). The buffer is capped by
// net.core.rmem_max.
constexpr int kReceiveBufferBytes = 4 << 20;
constexpr int kLcmQueue = 100'000;
// How soon the thread notices that it shall end.
constexpr int kPollMs = 50;
// Messages taken from one port before the other has its turn.
constexpr int kTurn = 64;

std::string url(const BusOptions& o, int port) {
  return "udpm://" + o.group + ":" + std::to_string(port) + "?ttl=" + std::to_string(o.ttl) +
         "&recv_buf_size=" + std::to_string(kReceiveBufferBytes);
}

}  // namespace

Tapped TapBatch::add(HostTime arrival, std::string_view channel, std::span<const std::uint8_t> data,
                     std::size_t max_bytes) {
  if (data.size() > channels::kMaxMessageBytes) return Tapped::kOversized;
  if (bytes_.size() + channel.size() + data.size() > max_bytes) return Tapped::kNoRoom;
  entries_.push_back({arrival, static_cast<std::uint32_t>(channel.size()), static_cast<std::uint32_t>(data.size()),
                      bytes_.size()});
  bytes_.insert(bytes_.end(), channel.begin(), channel.end());
  bytes_.insert(bytes_.end(), data.begin(), data.end());
  return Tapped::kKept;
}

void TapBatch::clear() {
  entries_.clear();
  bytes_.clear();
}

TapBatch::Message TapBatch::operator[](std::size_t i) const {
  const Entry& e = entries_[i];
  const std::uint8_t* start = bytes_.data() + e.at;
  return {
      e.arrival, {reinterpret_cast<const char*>(start), e.channel_bytes}, {start + e.channel_bytes, e.data_bytes}};
}

struct RecorderTap::Connections {
  RecorderTap& tap;
  lcm::LCM ports[2];

  Connections(RecorderTap& owner, const BusOptions& o)
      : tap(owner), ports{lcm::LCM(url(o, o.port)), lcm::LCM(url(o, o.port + 1))} {
    for (lcm::LCM& port : ports) {
      if (!port.good() || port.getFileno() < 0)
        throw std::runtime_error("cannot listen on the bus at " + url(o, o.port) +
                                 ": there is no multicast route, or a program that does not share holds the port; "
                                 "start it with scripts/run, or choose another --port");
      port.subscribe(".*", &Connections::handle, this)->setQueueCapacity(kLcmQueue);
    }
  }
  void handle(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    const std::span data(static_cast<const std::uint8_t*>(buffer->data), buffer->data_size);
    const std::lock_guard lock(tap.mutex_);
    const Tapped how = tap.arrived_.add(host_now(), channel, data, kMaxBatchBytes);
    if (how == Tapped::kNoRoom) ++tap.overflow_;
    if (how == Tapped::kOversized) ++tap.oversized_;
  }
};

RecorderTap::RecorderTap(const BusOptions& options) : connections_(std::make_unique<Connections>(*this, options)) {
  thread_ = std::thread([this] { listen(); });
}

RecorderTap::~RecorderTap() { stop(); }

void RecorderTap::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void RecorderTap::listen() {
  pollfd fds[2] = {{connections_->ports[0].getFileno(), POLLIN, 0},
                   {connections_->ports[1].getFileno(), POLLIN, 0}};
  while (true) {
    const bool last = stop_;
    poll(fds, 2, last ? 0 : kPollMs);
    bool more = true;
    while (more) {
      more = false;
      for (lcm::LCM& port : connections_->ports)
        for (int i = 0; i < kTurn && port.handleTimeout(0) > 0; ++i) more = true;
    }
    if (last) return;
  }
}

void RecorderTap::take(TapBatch& batch) {
  batch.clear();
  const std::lock_guard lock(mutex_);
  std::swap(batch, arrived_);
}

}  // namespace tactus::sync
