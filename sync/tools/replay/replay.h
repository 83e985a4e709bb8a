// Plays a log: selects the events that are due, with pause, speed, seek and loop. Pure.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "sync/log/timestamped_events.h"
#include "sync/tools/replay/replay_stamps.h"

namespace tactus::sync {

struct ReplayOptions {
  double speed = 1;    // recorded seconds per second; 0: as fast as max_per_s permits
  double start_s = 0;  // since the log's live part began
  double end_s = -1;   // since the log's live part began; negative: the end of the log
  bool loop = false;
  bool paused = false;
  double max_per_s =
      16'000;  // messages; design: lcm-logger, whose receive buffer has LCM's default size, receives 20,000 a second without loss
  bool from_head = false;  // time counts from the first event, and the head is played, too
};

class Replay {
 public:
  static constexpr double kMinSpeed = 0.01, kMaxSpeed = 100;
  // Maximum of one poll: LCM's own queue holds 30 messages, and its default receive buffer 90.
  static constexpr int kBurst = 20;
  // Events of the log read in one poll, sent or not.
  static constexpr int kMaxEventsPerPoll = 20'000;
  // A replay that is this far behind its time does not catch up: it continues from its position, later by this, and counts
  // the delay.
  static constexpr Nanoseconds kMaxBehind{100'000'000};

  // run: its number, from 1, or TimestampedEvents::kWholeFile. The index is complete and outlives this object. Throws
  // std::runtime_error with one sentence when the log holds no event, or lacks the part that the options select.
  Replay(const LogIndex& index, int run, const ReplayOptions& options, HostTime now);

  // Passes on the due events. take: returns true when the event was sent, so that it counts.
  using Take = std::function<bool(const LogEvent&, const ReplayMoment&)>;
  void poll(HostTime now, const Take& take);

  void pause(HostTime now);
  void resume(HostTime now);
  // Plays this number of recorded seconds, then pauses.
  void step(double seconds, HostTime now);
  void seek(double seconds, HostTime now);
  // Speed as in the options. Returns false for an invalid speed.
  bool set_speed(double speed, HostTime now);
  void set_loop(bool loop) { loop_ = loop; }

  double position_s() const { return seconds(position_ - begin_); }
  double length_s() const { return seconds(end_ - begin_); }
  double speed() const { return speed_; }
  bool paused() const { return paused_; }
  bool loop() const { return loop_; }
  // At the end, without a loop.
  bool over() const { return over_; }
  std::int64_t sent() const { return sent_; }
  std::int64_t passes() const { return pass_; }
  // Total delay behind the selected speed.
  double behind_s() const { return seconds(behind_); }

 private:
  static double seconds(Nanoseconds d) { return static_cast<double>(d.count()) * 1e-9; }
  void anchor(HostTime now) { anchor_live_ = now, anchor_recorded_ = position_; }
  void jump(HostTime to, HostTime now);
  HostTime due(HostTime now) const;
  bool read();

  TimestampedEvents events_;
  HostTime begin_{}, start_{}, end_{};
  HostTime position_{};
  HostTime anchor_live_{}, anchor_recorded_{};
  double speed_;
  double max_per_s_;
  double budget_ = 0;
  HostTime polled_{};
  HostTime position_polled_{};
  double measured_speed_ = 1;
  bool loop_, paused_, over_ = false;
  std::optional<HostTime> pause_at_;
  std::optional<LogEvent> pending_;
  HostTime pending_at_{};
  std::int64_t pass_ = 0, sent_ = 0;
  Nanoseconds behind_{0};
};

}  // namespace tactus::sync
