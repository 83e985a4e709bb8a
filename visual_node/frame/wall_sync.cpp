#include "visual_node/frame/wall_sync.h"

#include <algorithm>
#include <tactus/header_t.hpp>
#include <tactus/playout_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/clocks/pacing.h"

namespace tactus::visual {
namespace {

constexpr sync::Nanoseconds kPollInterval{
    1'000'000};  // period of the check whether the others are ready; messages also trigger it

// After a stall, the missed messages come through a thread of the bus, which takes time: less than this for
// messages of 0.2 s. Design.
constexpr sync::Nanoseconds kCatchUp{10'000'000};

}  // namespace

WallSync::WallSync(sync::Node& node, FrameLock& lock)
    : node_(node),
      lock_(lock),
      world_(node.bus().queue<world_state_t>(channels::kWorldState, 4096)),
      tools_(node.bus().queue<tool_state_t>(channels::kToolState, 4096)),
      playouts_(node.bus().queue<playout_t>(channels::kPlayout, 64)),
      walls_(node.bus().queue<frame_shown_t>(channels::kFrameShown, 256)) {}

void WallSync::receive() {
  const auto ours = [&](const header_t& h) { return h.run_id == node_.options().run_id; };
  while (const auto m = world_.pop()) lock_.push(m->message, m->arrival);
  while (const auto m = tools_.pop()) lock_.push(m->message, m->arrival);
  while (const auto m = playouts_.pop())
    if (ours(m->message.header)) lock_.push(m->message, m->arrival);
  while (const auto m = walls_.pop())
    if (ours(m->message.header)) lock_.push(m->message, m->arrival);
}

void WallSync::catch_up(const std::function<void(sync::HostTime)>& meanwhile) {
  sync::HostTime now = node_.poll();
  meanwhile(now);
  const bool held_up = now - last_ > 2 * lock_.period();
  const sync::HostTime until = now + kCatchUp;
  for (; held_up && now < until && !lock_.inputs_complete(now); meanwhile(now)) {
    node_.bus().wait(std::min(kPollInterval, until - now));
    now = node_.poll();
  }
  last_ = now;
}

void WallSync::wait_for_latch(const LockedFrame& frame) const {
  sync::sleep_until(std::min(lock_.latch_time(frame), sync::host_now() + lock_.period()));
}

void WallSync::hold(const LockedFrame& frame, const std::function<void(sync::HostTime)>& meanwhile) {
  const sync::HostTime ready = sync::host_now();
  if (lock_.waits_for_peers()) {
    publish_stage(frame, frame_shown_t::READY);
    const sync::HostTime until = ready + lock_.max_wait();
    for (sync::HostTime now = ready; now < until && !lock_.peers_ready(frame, now); now = sync::host_now()) {
      node_.bus().wait(std::min(kPollInterval, until - now));
      meanwhile(node_.poll());
    }
  }
  sync::sleep_until(std::min(frame.due_host_time, ready + lock_.period()));
  lock_.shown(frame, sync::host_now());
}

void WallSync::publish_stage(const LockedFrame& frame, std::int8_t stage) {
  frame_shown_t m = lock_.message(frame, stage);
  node_.bus().publish(channels::kFrameShown, m);
}

}  // namespace tactus::visual
