#include "visual_node/frame/frame_lock.h"

#include <algorithm>
#include <tactus/playout_entry_t.hpp>
#include <tactus/sim_clock_t.hpp>

#include "lcmtypes/pointing.h"
#include "sync/playout/lockstep.h"

namespace tactus::visual {
namespace {

// Limit of the skipped frames when a clock is put forward: half an hour at 60 Hz.
constexpr std::int64_t kMaxSkipped = 100'000;

}  // namespace

void FrameLock::load(const scene_t& scene, const Settings& s) {
  mode_ = s.room == "none" || s.frame_lock == "off" ? Mode::kOff
          : s.frame_lock == "wait"                  ? Mode::kWait
                                                    : Mode::kTime;
  lag_ = sync::from_seconds(s.frame_lag_s);
  max_wait_ = sync::from_seconds(s.lock_wait_s);
  grid_ = FrameGrid(s.rate_Hz);
  head_tool_ = head_of(scene);
  heads_.clear();
}

void FrameLock::push(const world_state_t& m, sync::HostTime arrival) {
  clock_.on_message(m.header, m.clock, arrival);
  if (clock_.clocks() == clock_count_) return;
  clock_count_ = clock_.clocks();
  grid_.restart();
  delay_.restart();
  heads_.clear();
}

void FrameLock::push(const tool_state_t& m, sync::HostTime arrival) {
  if (m.tool == head_tool_ && clock_.known()) heads_.push(m, clock_.sent(m.header, arrival), arrival);
}

void FrameLock::push(const playout_t& m, sync::HostTime arrival) {
  lockstep_Hz_ = m.lockstep_Hz;
  if (!clock_.known()) return;
  for (const playout_entry_t& e : m.entries)
    if (e.modality == modality_) delay_.request(clock_.sent(m.header, arrival), sync::Nanoseconds(e.delay_ns));
}

bool FrameLock::inputs_complete(sync::HostTime now) const {
  if (!active()) return true;
  const RoomTime by = clock_.to_room(now + expected_draw_time(), now) - lag_;
  const auto head = heads_.newest();
  return clock_.newest() >= by && (!head || *head >= by);
}

std::optional<LockedFrame> FrameLock::begin_frame(sync::HostTime now, sync::Nanoseconds profile_delay) {
  if (!active()) return std::nullopt;
  LockedFrame frame;
  const std::optional<std::int64_t> before = grid_.last();
  frame.number = grid_.select_next(clock_.to_room(now + expected_draw_time() - kGrace, now));
  if (before) frame.skipped = std::clamp<std::int64_t>(frame.number - *before - 1, 0, kMaxSkipped);
  frame.due = grid_.due(frame.number);
  frame.due_host_time = clock_.to_host(frame.due, now);
  const RoomTime by = frame.due - lag_;
  set_world_instant(frame, by, profile_delay);
  heads_.extend_history(profile_delay);
  if (const auto sample = heads_.published_by(by - profile_delay)) {
    frame.head = extrapolate(*sample, frame.due - profile_delay);
    frame.head_ns = sample->publish_ns;
    frame.head_seq = sample->seq;
  }
  return frame;
}

sync::Nanoseconds FrameLock::lead_time() const {
  const sync::Nanoseconds safe = surfaces_.second_longest() + flashes_.second_longest() + kMargin;
  return std::max(expected_draw_time(), std::min(safe, lag_ - kMessageLatency));
}

void FrameLock::set_world_instant(LockedFrame& frame, RoomTime by, sync::Nanoseconds profile_delay) {
  const sim_clock_t published = clock_.published_by(by);
  // The host times of this map are the room's.
  const sync::TimeMap map{sync::sim_time(published.sim_ns), sync::host_time(published.host_ns), published.rate};
  const sync::HostTime due = sync::host_time(sync::to_ns(frame.due));
  frame.delay = delay_.at(frame.due, by) + profile_delay;
  frame.sim_time = map.to_sim(due - frame.delay);
  if (lockstep_Hz_ <= 0 || map.rate <= 0) return;
  const sync::HostTime step_begin = sync::Lockstep{map, lockstep_Hz_}.begin_of_iteration(due - frame.delay);
  frame.delay = due - step_begin;
  frame.sim_time = map.to_sim(step_begin);
}

sync::HostTime FrameLock::latch_time(const LockedFrame& frame) const {
  return frame.due_host_time - flashes_.second_longest() - kMargin / 2;
}

void FrameLock::add_draw_times(sync::Nanoseconds surfaces, sync::Nanoseconds flashes) {
  surfaces_.add(surfaces);
  flashes_.add(flashes);
}

sync::HostTime FrameLock::next_begin(sync::HostTime now) const {
  return clock_.to_host(grid_.due(grid_.next(clock_.to_room(now + lead_time(), now))), now) - lead_time();
}

frame_shown_t FrameLock::message(const LockedFrame& frame, std::int8_t stage) const {
  frame_shown_t m{};
  m.header.sim_time_ns = sync::to_ns(frame.sim_time);
  m.frame = frame.number;
  m.due_ns = sync::to_ns(frame.due);
  m.head_ns = frame.head_ns;
  m.stage = stage;
  return m;
}

std::string FrameLock::status_text(sync::HostTime now) const {
  if (!active()) return "";
  if (heads_.conflict(now)) return "two programs control the head; the first one counts, stop the other";
  if (!clock_.mapped(now)) return "walls by arrival: no map of sim_node's clock";
  if (head_tool_ >= 0 && expected_draw_time() + kMessageLatency > lag_)
    return "drawing takes longer than frame_lag: other walls have a newer head";
  if (const int left = peers_.ignored(now); waits_for_peers() && left > 0)
    return "ignores " + std::to_string(left) + " of " + std::to_string(peers_.present(now)) + " walls";
  return "";
}

}  // namespace tactus::visual
