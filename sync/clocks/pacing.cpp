#include "sync/clocks/pacing.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sync/virtual_time/virtual_time.h"

namespace tactus::sync {

HostTime host_now() {
  if (const VirtualTime* time = VirtualTime::current()) return time->now();
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return host_time(t.tv_sec * 1'000'000'000 + t.tv_nsec);
}

std::int64_t realtime_ns() {
  return std::chrono::duration_cast<Nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

void Deadlines::set_rate(double rate_Hz) {
  if (!(rate_Hz > 0 && rate_Hz <= 10000))
    throw std::invalid_argument("a rate of " + std::to_string(rate_Hz) + " Hz is impossible; choose 0 < rate <= 10000 Hz");
  if (rate_Hz == rate_Hz_) return;
  rate_Hz_ = rate_Hz;
  start_ = next_;
  since_start_ = 0;
}

std::int64_t Deadlines::advance(HostTime now) {
  const double period_ns = 1e9 / rate_Hz_;
  std::int64_t skipped = 0;
  if (now > next_) skipped = static_cast<std::int64_t>(static_cast<double>((now - next_).count()) / period_ns);
  since_start_ += 1 + skipped;
  next_ = start_ + Nanoseconds(std::llround(static_cast<double>(since_start_) * period_ns));
  ++ticks_;
  missed_ += skipped;
  return skipped;
}

void Deadlines::align(HostTime next, std::int64_t skipped) {
  start_ = next_ = next;
  since_start_ = 0;
  missed_ += skipped;
}

void sleep_until(HostTime t) {
  if (VirtualTime* time = VirtualTime::current()) return time->sleep_until(t);
  const timespec at{to_ns(t) / 1'000'000'000, to_ns(t) % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
}

HostTime Loop::wait() {
  sleep_until(deadlines_.next());
  const HostTime now = host_now();
  lateness_ = std::max(Nanoseconds(0), now - deadlines_.next());
  deadlines_.advance(now);
  return now;
}

}  // namespace tactus::sync
