#include "sync/tools/recorder/recorder_tap.h"

#include <poll.h>

#include "sync/bus/receive_buffer.h"
#include "sync/clocks/pacing.h"
#include "sync/tools/recorder/read_in_turns.h"
#include "sync/virtual_time/virtual_time.h"

namespace tactus::sync {
namespace {

// Maximum time until the thread detects its stop, ms.
constexpr int kPollMs = 50;
// Messages read from one port before the other is read.
constexpr int kBatch = 64;
// Messages read before the thread checks for its stop, and at most after it: more than the buffers of both sockets hold at
// that moment (udp_port.cpp). Later messages were sent after the end of the recording.
constexpr int kMaxAtOnce = 50'000;

}  // namespace

RecorderTap::Ports::Ports(const BusOptions& options)
    : both{UdpPort(options.group, options.port), UdpPort(options.group, options.port + 1)} {}

RecorderTap::RecorderTap(const BusOptions& options) {
  if (VirtualTime* time = VirtualTime::current()) {
    listener_ = time->wire().add_listener([this](HostTime, std::string_view channel, std::span<const std::uint8_t> data) { store({channel, data}); });
    return;
  }
  ports_.emplace(options);
  thread_ = std::thread([this] { run(); });
}

RecorderTap::~RecorderTap() { stop(); }

void RecorderTap::stop() {
  if (!ports_) VirtualTime::current()->wire().remove_listener(listener_);
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void RecorderTap::store(const ChannelBytes& m) {
  if (!m.fits())
    ++oversized_;
  else if (!arrived_.add(host_now(), m, kMaxBatchBytes))
    ++overflow_;
}

void RecorderTap::run() {
  drop_receive_buffer_right();
  pollfd fds[2] = {{ports_->both[0].descriptor(), POLLIN, 0}, {ports_->both[1].descriptor(), POLLIN, 0}};
  while (true) {
    const bool last = stop_;
    poll(fds, 2, last ? 0 : kPollMs);
    read_in_turns(ports_->both, kBatch, kMaxAtOnce, [this](UdpPort& port, int batch) {
      const std::lock_guard lock(mutex_);
      return port.read(batch, [this](const ChannelBytes& m) { store(m); });
    });
    if (last) return;
  }
}

void RecorderTap::take(MessageBatch& batch) {
  batch.clear();
  const std::lock_guard lock(mutex_);
  std::swap(batch, arrived_);
}

}  // namespace tactus::sync
