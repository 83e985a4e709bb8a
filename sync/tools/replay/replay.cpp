#include "sync/tools/replay/replay.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tactus::sync {
namespace {

Nanoseconds scaled(Nanoseconds d, double factor) {
  return Nanoseconds(std::llround(static_cast<double>(d.count()) * factor));
}
// Times given by the user, limited to possible lengths of a log.
Nanoseconds bounded(double seconds) {
  return from_seconds(std::clamp(std::isfinite(seconds) ? seconds : 0.0, -1e8, 1e8));
}

}  // namespace

Replay::Replay(const LogIndex& index, int run, const ReplayOptions& o, HostTime now)
    : events_(index, run),
      speed_(o.speed),
      max_per_s_(std::max(1.0, o.max_per_s)),
      loop_(o.loop),
      paused_(o.paused) {
  if (index.events() == 0)
    throw std::runtime_error("is not an LCM log, or contains no intact event; give the run.lcmlog of a run");
  const LogOrigin& origin = events_.origin();
  begin_ = origin.time(events_.first_us());
  end_ = std::max(begin_, origin.time(events_.last_us()));
  const HostTime live = host_time(origin.info.live_from_ns);
  if (!o.from_head && origin.recovered.empty() && live > begin_ && live <= end_) begin_ = live;
  if (o.end_s >= 0) end_ = std::min(end_, begin_ + bounded(o.end_s));
  start_ = begin_ + bounded(o.start_s);
  if (start_ < begin_ || start_ > end_)
    throw std::runtime_error("has no time from --start to --end; it lasts " + std::to_string(length_s()) + " s");
  if (speed_ != 0 && (speed_ < kMinSpeed || speed_ > kMaxSpeed || !std::isfinite(speed_)))
    throw std::runtime_error("cannot be played at that speed; give one from 0.01 to 100, or max");
  polled_ = now;
  jump(start_, now);
  pass_ = 0;
}

void Replay::jump(HostTime to, HostTime now) {
  position_ = position_polled_ = std::clamp(to, begin_, end_);
  events_.seek(position_);
  pending_.reset();
  over_ = false;
  ++pass_;
  anchor(now);
  // Skips earlier events without sending them. Stamps are truncated to whole microseconds.
  while (read() && pending_at_ < position_ - Nanoseconds(1000)) pending_.reset();
}

bool Replay::read() {
  if (pending_) return true;
  LogEvent e;
  if (!events_.next(e, pending_at_)) return false;
  pending_ = e;
  return true;
}

HostTime Replay::due(HostTime now) const {
  if (speed_ == 0) return end_;
  return std::min(end_, anchor_recorded_ + scaled(now - anchor_live_, speed_));
}

void Replay::poll(HostTime now, const Take& take) {
  const double passed_s = std::max(0.0, seconds(now - polled_));
  budget_ = std::min<double>(kBurst, budget_ + passed_s * max_per_s_);
  if (speed_ == 0 && passed_s > 0 && !paused_ && !over_) {
    const double s = seconds(position_ - position_polled_) / passed_s;
    measured_speed_ = std::clamp(0.9 * measured_speed_ + 0.1 * s, kMinSpeed, kMaxSpeed);
  }
  polled_ = now;
  position_polled_ = position_;
  if (paused_ || over_) return;
  const HostTime until = std::min(due(now), pause_at_.value_or(HostTime::max()));
  const double speed = speed_ == 0 ? measured_speed_ : speed_;
  for (int events_read = 0; events_read < kMaxEventsPerPoll; ++events_read) {
    if (!read() || pending_at_ > end_) {
      if (pause_at_ && *pause_at_ <= end_ && due(now) >= *pause_at_) return pause(now);
      if (due(now) < end_) return;  // the silence before the end is played, too
      if (loop_) return jump(start_, now);
      position_ = end_;
      over_ = true;
      return;
    }
    if (pending_at_ > until) {
      position_ = std::max(position_, until);
      if (pause_at_ && until >= *pause_at_) pause(now);
      return;
    }
    if (budget_ < 1) break;
    const HostTime at = std::max(pending_at_, position_);
    const HostTime live = speed_ == 0 ? now : anchor_live_ + scaled(at - anchor_recorded_, 1 / speed);
    const LogEvent event = *pending_;
    pending_.reset();
    position_ = at;
    if (!take(event, {at, std::min(live, now), speed, pass_})) continue;
    ++sent_;
    budget_ -= 1;
  }
  // More events are due than may be sent or read in one poll.
  if (speed_ == 0) return;
  const Nanoseconds behind = now - anchor_live_ - scaled(position_ - anchor_recorded_, 1 / speed_);
  if (behind <= kMaxBehind) return;
  behind_ += behind;
  anchor(now);
}

void Replay::pause(HostTime now) {
  if (!paused_ && pause_at_) position_ = std::max(position_, std::min(*pause_at_, end_));
  pause_at_.reset();
  paused_ = true;
  anchor(now);
}

void Replay::resume(HostTime now) {
  if (over_) jump(start_, now);
  if (paused_) anchor(now);
  pause_at_.reset();
  paused_ = false;
}

void Replay::step(double s, HostTime now) {
  if (over_) return;
  const HostTime to = position_ + std::max(Nanoseconds(0), bounded(s));
  if (paused_) anchor(now);
  paused_ = false;
  pause_at_ = to;
}

void Replay::seek(double s, HostTime now) { jump(begin_ + bounded(s), now); }

bool Replay::set_speed(double speed, HostTime now) {
  if (!std::isfinite(speed) || (speed != 0 && (speed < kMinSpeed || speed > kMaxSpeed))) return false;
  if (!paused_ && !over_) position_ = speed_ == 0 ? position_ : std::max(position_, due(now));
  anchor(now);
  speed_ = speed;
  measured_speed_ = 1;
  return true;
}

}  // namespace tactus::sync
