#include "sync/clock_sync/probe_thread.h"

#include <random>
#include <tactus/clock_probe_t.hpp>

#include "sync/clocks/pacing.h"

namespace tactus::sync {

ProbeThread::ProbeThread(const BusOptions& options, const Identity& own, const EmulatedClock& clock)
    : own_(own), clock_(clock), socket_(options), prober_(own, host_now()), thread_([this] { run(); }) {}

ProbeThread::~ProbeThread() {
  stop_ = true;
  socket_.wake();
  thread_.join();
}

void ProbeThread::send(clock_probe_t probe) {
  probe.header = {-1, 0, own_.clock, own_.run_id, own_.source, own_.incarnation, seq_++};
  const HostTime host = host_now();
  probe.header.publish_time_ns = to_ns(host);
  const std::int64_t now_ns = to_ns(clock_.read(host));
  if (probe.kind == clock_probe_t::REPLY) {
    // The clock was set back meanwhile: no valid answer is possible.
    if (now_ns < probe.request_arrived_ns) return;
    probe.reply_sent_ns = now_ns;
  }
  socket_.send(probe);
}

void ProbeThread::process(const ProbeSocket::Received& received) {
  const HostTime at = clock_.read(received.at);
  if (received.probe.kind == clock_probe_t::REPLY) {
    if (received.probe.header.run_id == own_.run_id) prober_.reply(received.probe, at);
    return;
  }
  if (replies_ >= kMaxRepliesPerPeriod) return;
  if (const auto reply = probe_reply(received.probe, own_, at)) {
    ++replies_;
    send(*reply);
  }
}

void ProbeThread::run() {
  std::random_device random;
  std::uniform_int_distribution<std::int64_t> nonces;
  while (!stop_) {
    if (const auto received = socket_.receive(prober_.next())) process(*received);
    const HostTime now = host_now();
    if (const auto request = prober_.request(now, clock_.read(now), nonces(random))) send(*request);
    const auto waves = prober_.finish(now);
    for (const ProbeWave& wave : waves) waves_.push(wave);
    if (now - replies_since_ < ClockProber::kPeriod) continue;
    replies_since_ = now;
    replies_ = 0;
  }
}

}  // namespace tactus::sync
