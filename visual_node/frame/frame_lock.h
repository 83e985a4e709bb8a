// Frame lock of the walls of a room, without a barrier: every wall selects the frame that is due when its picture
// can be seen, and the content of a frame follows from its number. Pure: the loop waits.
//
//   lock.push(...)                       received messages
//   frame = lock.begin_frame(now, ...)         which frame this tick draws; nothing: there is no lock
//   ... draw the surfaces, wait until lock.latch_time(frame), draw the flashes ...
//   lock.add_draw_times(...)                      how long that took
//   ... with `wait`: until lock.peers_ready(frame, now), for at most max_wait() ...
//   ... wait until frame.due_host_time, show it ...
//   lock.shown(frame, now)
//   ... sleep until lock.next_begin(now) ...
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tactus/frame_shown_t.hpp>
#include <tactus/playout_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>

#include "visual_node/frame/frame_grid.h"
#include "visual_node/frame/frame_peers.h"
#include "visual_node/frame/head_samples.h"
#include "visual_node/frame/locked_frame.h"
#include "visual_node/frame/render_time.h"
#include "visual_node/frame/room_clock_reader.h"
#include "visual_node/frame/room_delay.h"
#include "visual_node/settings.gen.h"

namespace tactus::visual {

class FrameLock {
 public:
  // A picture should be ready this long before it is due. Design: wake-up latency of a normal thread while others
  // run.
  static constexpr sync::Nanoseconds kMargin{1'000'000};
  // A picture that is late by at most this is shown late and not skipped. Design: p99 of that wake-up latency.
  static constexpr sync::Nanoseconds kGrace{3'000'000};
  // Nearly every message takes less than this from its sender to a wall. Design: two ticks of 1 kHz.
  static constexpr sync::Nanoseconds kMessageLatency{2'000'000};

  FrameLock(sync::OwnClock own, std::string modality, std::int64_t incarnation)
      : modality_(std::move(modality)), incarnation_(incarnation), clock_(own) {}

  // Loads a new scene and the settings.
  void load(const scene_t& scene, const Settings& settings);

  // These take world and tools from the bus, before degradation by the profile, which delays messages and changes
  // their stamps: the position of the eye is not an event, and all walls must agree on it.
  void push(const world_state_t& m, sync::HostTime arrival);
  void push(const tool_state_t& m, sync::HostTime arrival);
  void push(const playout_t& m, sync::HostTime arrival);
  void push(const frame_shown_t& m, sync::HostTime arrival) { peers_.on_message(m, incarnation_, arrival); }

  // True when all inputs of a frame begun at `now` have arrived, which newer messages of their senders show.
  // False also when the senders are gone.
  bool inputs_complete(sync::HostTime now) const;
  // Selects the frame to draw from now on; nothing without a room, or before the first message of sim_node.
  // profile_delay: the delay that a profile adds to this modality.
  std::optional<LockedFrame> begin_frame(sync::HostTime now,
                                         sync::Nanoseconds profile_delay = sync::Nanoseconds(0));
  // When to draw the flashes of that frame: late, but so that it is ready when it is due.
  sync::HostTime latch_time(const LockedFrame& frame) const;
  // Reports the drawing time of its surfaces, from begin on, and of its flashes.
  void add_draw_times(sync::Nanoseconds surfaces, sync::Nanoseconds flashes);
  // Best start of the next tick: its picture is ready just in time.
  sync::HostTime next_begin(sync::HostTime now) const;
  // Upper limit of every wait, also when a clock jumps.
  sync::Nanoseconds period() const { return grid_.period(); }

  bool active() const { return mode_ != Mode::kOff && clock_.known(); }
  bool waits_for_peers() const { return mode_ == Mode::kWait; }
  sync::Nanoseconds max_wait() const { return max_wait_; }
  bool peers_ready(const LockedFrame& frame, sync::HostTime now) const { return peers_.ready(frame.number, now); }
  void shown(const LockedFrame& frame, sync::HostTime now) { peers_.shown(frame.number, now); }

  // The FRAME_SHOWN message of a frame.
  frame_shown_t message(const LockedFrame& frame, std::int8_t stage) const;
  // The problem of the lock, for the health message; empty: none.
  std::string status_text(sync::HostTime now) const;

 private:
  enum class Mode { kOff, kTime, kWait };
  // How long before its due time a picture is begun: longer than nearly all take, but not before the head is
  // known that the other walls use. The few slower pictures are late. A wall that is always slow begins as early
  // as it must.
  sync::Nanoseconds lead_time() const;
  sync::Nanoseconds expected_draw_time() const { return surfaces_.expected() + flashes_.expected(); }
  void set_world_instant(LockedFrame& frame, RoomTime by, sync::Nanoseconds profile_delay);

  std::string modality_;
  std::int64_t incarnation_;
  Mode mode_ = Mode::kOff;
  sync::Nanoseconds lag_{0}, max_wait_{0};
  RoomClockReader clock_;
  std::int64_t clock_count_ = 0;
  FrameGrid grid_;
  RoomDelay delay_;
  double lockstep_Hz_ = 0;
  HeadSamples heads_;
  int head_tool_ = -1;
  FramePeers peers_;
  RenderTime surfaces_, flashes_{sync::Nanoseconds(1'000'000)};
};

}  // namespace tactus::visual
