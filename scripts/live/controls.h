// Carries out the requests of pages in the cluster, as tactus simulate, degrade and set do, but without waiting: each
// request is repeated until it is answered or has been sent for long enough. Bounded: a new request replaces the previous one
// of its kind.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <tactus/contact_frame_t.hpp>
#include <tactus/degradation_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/setting_change_t.hpp>
#include <tactus/setting_reply_t.hpp>
#include <tactus/sim_clock_t.hpp>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <tactus/tag_request_t.hpp>
#include <tactus/tool_state_t.hpp>

#include "scripts/live/browser_message.h"
#include "scripts/live/hand.h"
#include "sync/bus/bus.h"
#include "sync/degradation/profile_exchange.h"
#include "sync/assets/scene_receiver.h"
#include "sync/clocks/sim_clock_tracker.h"

namespace tactus::live {

class Controls {
 public:
  using ReplyHandler = std::function<void(const std::string& sentence, bool good)>;
  explicit Controls(sync::Bus& bus, ReplyHandler on_reply);

  // realtime_ns: CLOCK_REALTIME, which numbers profiles. Each throws std::invalid_argument with one sentence for an invalid
  // request.
  void command(const Command& command, sync::HostTime now);
  void degrade(const DegradeRequest& sliders, std::int64_t realtime_ns, sync::HostTime now);
  void hand(const HandTarget& at, double aspect, sync::HostTime now);
  // Requests pictures from visual_node at this rate; 0: none.
  void stream(double rate_Hz, sync::HostTime now);
  void request_tags(const std::vector<std::string>& names, sync::HostTime now);

  // Call it once per iteration of the loop: sends due messages and reads the answers.
  void step(sync::HostTime now);

  struct World {
    double sim_s = 0, rate = 0;
    bool known = false;
  };
  World world(sync::HostTime now) const;
  // The profile in force, from any sender; nullopt: none has been received.
  const std::optional<sync::ProfileInForce>& profile() const { return in_force_; }
  const scene_t* scene() const { return scene_.scene(); }

 private:
  template <class Message>
  struct PendingRequest {
    Message message;
    sync::HostTime until, next;
  };
  sync::Bus& bus_;
  ReplyHandler on_reply_;
  sync::Queue<sim_reply_t>& replies_;
  sync::Queue<setting_reply_t>& setting_replies_;
  sync::Queue<contact_frame_t>& frames_;
  sync::Queue<tool_state_t>& tools_;
  sync::Queue<degradation_t>& degradations_;
  sync::SceneReceiver scene_;
  sync::SimClockTracker simulation_;
  Hand hand_;
  std::optional<tool_state_t> tool_;
  std::optional<sim_clock_t> clock_;
  std::optional<PendingRequest<sim_command_t>> command_;
  std::optional<PendingRequest<setting_change_t>> setting_;
  sync::ProfileReceiver profiles_;
  std::optional<sync::ProfileInForce> in_force_, profile_;
  sync::HostTime profile_until_{}, profile_next_{};
  tag_request_t tags_{};
  std::optional<sync::HostTime> tags_next_;
};

}  // namespace tactus::live
