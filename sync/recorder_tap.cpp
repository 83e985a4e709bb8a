#include "sync/recorder_tap.h"

#include <poll.h>

#include "sync/pacing.h"

namespace tactus::sync {
namespace {

// How soon the thread notices that it shall end.
constexpr int kPollMs = 50;
// Messages taken from one port before the other has its turn.
constexpr int kTurn = 64;

}  // namespace

RecorderTap::RecorderTap(const BusOptions& options)
    : ports_{UdpPort(options.group, options.port), UdpPort(options.group, options.port + 1)} {
  thread_ = std::thread([this] { listen(); });
}

RecorderTap::~RecorderTap() { stop(); }

void RecorderTap::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void RecorderTap::keep(const ChannelBytes& m) {
  if (!m.fits())
    ++oversized_;
  else if (!arrived_.add(host_now(), m, kMaxBatchBytes))
    ++overflow_;
}

void RecorderTap::listen() {
  pollfd fds[2] = {{ports_[0].descriptor(), POLLIN, 0}, {ports_[1].descriptor(), POLLIN, 0}};
  while (true) {
    const bool last = stop_;
    poll(fds, 2, last ? 0 : kPollMs);
    bool more = true;
    while (more) {
      more = false;
      for (UdpPort& port : ports_) {
        const std::lock_guard lock(mutex_);
        more |= port.read(kTurn, [this](const ChannelBytes& m) { keep(m); }) > 0;
      }
    }
    if (last) return;
  }
}

void RecorderTap::take(MessageBatch& batch) {
  batch.clear();
  const std::lock_guard lock(mutex_);
  std::swap(batch, arrived_);
}

}  // namespace tactus::sync
