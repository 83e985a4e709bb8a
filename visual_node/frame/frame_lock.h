// Locks the frames of the walls of a room without a barrier: every wall draws by itself the frame that is due when
// its picture can be seen, and what a frame shows follows from its number. Pure: the loop waits.
//
//   lock.push(...)                       what arrives
//   frame = lock.begin(now, ...)         which frame this tick draws; nothing: there is no lock
//   ... draw the surfaces, wait until lock.latch_at(frame), draw the flashes ...
//   lock.drawn(...)                      how long that took
//   ... with `wait`: until lock.others_ready(frame, now), for at most wait_at_most() ...
//   ... wait until frame.here, show it ...
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

#include "visual_node/frame/agreed_delay.h"
#include "visual_node/frame/agreed_frame.h"
#include "visual_node/frame/frame_grid.h"
#include "visual_node/frame/frame_peers.h"
#include "visual_node/frame/head_samples.h"
#include "visual_node/frame/render_time.h"
#include "visual_node/frame/room_clock_reader.h"
#include "visual_node/settings.gen.h"

namespace tactus::visual {

class FrameLock {
 public:
  // A picture is meant to be ready so long before it is due. design: a normal thread wakes up so late beside
  // others
  static constexpr sync::Nanoseconds kMargin{1'000'000};
  // A picture that would be late by no more than this is shown late rather than left out. design: p99 of that
  // wake-up
  static constexpr sync::Nanoseconds kGrace{3'000'000};
  // From its sender to a wall a message takes less than this, nearly always. design: two ticks of 1 kHz
  static constexpr sync::Nanoseconds kOnTheWay{2'000'000};

  FrameLock(sync::OwnClock own, std::string modality, std::int64_t incarnation)
      : modality_(std::move(modality)), incarnation_(incarnation), clock_(own) {}

  // A new scene and what is set.
  void load(const scene_t& scene, const Settings& settings);

  // Of world and tools what crossed the bus, past the profile, which makes news late and stamps it anew: where the
  // eye is, is no event, and all walls must agree on it.
  void push(const world_state_t& m, sync::HostTime arrival);
  void push(const tool_state_t& m, sync::HostTime arrival);
  void push(const playout_t& m, sync::HostTime arrival);
  void push(const frame_shown_t& m, sync::HostTime arrival) { peers_.hear(m, incarnation_, arrival); }

  // Whether all that a frame begun at `now` depends on has been heard: somebody has spoken since. False too when
  // nobody speaks any more.
  bool heard_enough(sync::HostTime now) const;
  // The frame that is drawn from now on; nothing without a room, or before sim_node was heard. profile_delay: of
  // what a profile adds to this sense.
  std::optional<AgreedFrame> begin(sync::HostTime now, sync::Nanoseconds profile_delay = sync::Nanoseconds(0));
  // When the flashes of that frame are to be drawn: late, but so that it is ready when it is due.
  sync::HostTime latch_at(const AgreedFrame& frame) const;
  // Its surfaces took so long, from begin on; its flashes so long.
  void drawn(sync::Nanoseconds surfaces, sync::Nanoseconds flashes);
  // The next tick is best begun then, so that its picture is ready just in time.
  sync::HostTime next_begin(sync::HostTime now) const;
  // Nobody is held back for longer than this, whatever the clocks do.
  sync::Nanoseconds period() const { return grid_.period(); }

  bool on() const { return mode_ != Mode::kOff && clock_.known(); }
  bool waits() const { return mode_ == Mode::kWait; }
  sync::Nanoseconds wait_at_most() const { return wait_at_most_; }
  bool others_ready(const AgreedFrame& frame, sync::HostTime now) const { return peers_.ready(frame.number, now); }
  void shown(const AgreedFrame& frame, sync::HostTime now) { peers_.shown(frame.number, now); }

  // What is told of it.
  frame_shown_t message(const AgreedFrame& frame, std::int8_t stage) const;
  // What is wrong with the lock, for the reader of the health; empty: nothing.
  std::string note(sync::HostTime now) const;

 private:
  enum class Mode { kOff, kTime, kWait };
  // How long before it is due a picture is begun: as long as nearly none takes, but not so early that the head is
  // not known that the other walls use: the few that take longer are late instead. A wall that is always slow
  // begins as early as it must.
  sync::Nanoseconds lead() const;
  sync::Nanoseconds likely() const { return surfaces_.expected() + flashes_.expected(); }
  void show_world(AgreedFrame& frame, RoomTime by, sync::Nanoseconds profile_delay);

  std::string modality_;
  std::int64_t incarnation_;
  Mode mode_ = Mode::kOff;
  sync::Nanoseconds lag_{0}, wait_at_most_{0};
  RoomClockReader clock_;
  std::int64_t clock_count_ = 0;
  FrameGrid grid_;
  AgreedDelay delay_;
  double lockstep_Hz_ = 0;
  HeadSamples heads_;
  int head_tool_ = -1;
  FramePeers peers_;
  RenderTime surfaces_, flashes_{sync::Nanoseconds(1'000'000)};
};

}  // namespace tactus::visual
