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

void ProbeThread::take(const ProbeSocket::Arrived& arrived) {
  const HostTime at = clock_.read(arrived.at);
  if (arrived.probe.kind == clock_probe_t::REPLY) {
    if (arrived.probe.header.run_id == own_.run_id) prober_.reply(arrived.probe, at);
    return;
  }
  if (answers_ >= kAnswersPerPeriod) return;
  if (const auto answer = probe_answer(arrived.probe, own_, at)) {
    ++answers_;
    send(*answer);
  }
}

void ProbeThread::run() {
  std::random_device random;
  std::uniform_int_distribution<std::int64_t> nonces;
  while (!stop_) {
    if (const auto arrived = socket_.receive(prober_.next())) take(*arrived);
    const HostTime now = host_now();
    if (const auto request = prober_.request(now, clock_.read(now), nonces(random))) send(*request);
    const auto waves = prober_.finish(now);
    for (const ProbeWave& wave : waves) waves_.push(wave);
    if (now - answers_since_ < ClockProber::kPeriod) continue;
    answers_since_ = now;
    answers_ = 0;
  }
}

}  // namespace tactus::sync
