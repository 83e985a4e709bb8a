// Runs a scene without a clock: the simulation and the hands of the scene, step by step, with all their messages to the renderers kept as
// a log.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/world_state_t.hpp>
#include <vector>

#include "haptic_node/rendering/session.h"
#include "sim_node/world/simulation.h"
#include "sim_node/publish/publisher.h"
#include "sync/bus/bus.h"
#include "sync/log/log_writer.h"
#include "sync/resampling/event_inbox.h"

namespace tactus::bench {

inline constexpr std::int64_t kRun = 7;
inline constexpr std::int32_t kClock = 3;
inline constexpr std::int64_t kWorldBegins_ns = 10'000'000'000;  // host time of simulated time zero
inline sync::TimeMap world_map() { return {sync::sim_time(0), sync::host_time(kWorldBegins_ns), 1}; }

scene_t scene_of(const sim::WorldDef& world, sync::Nanoseconds step);

class OfflineWorld {
 public:
  // hands: whether the tools of the scene are held; log: destination of the messages, may be null. Throws std::runtime_error with one
  // sentence when the pairing of the settings is refused.
  OfflineWorld(const sim::WorldDef& world, const sim::Settings& settings, bool hands,
               std::unique_ptr<sync::LogSink> log);

  // One step of the world and one tick of each hand.
  void step();
  void finish() {
    if (log_) log_->flush();
  }

  sim::Simulation& simulation() { return simulation_; }
  const scene_t& scene() const { return scene_; }
  double step_us() const { return step_us_; }  // duration of the last step of the simulation
  // Values of the last tick: force on each hand, and the number of events that touch has presented so far.
  const std::vector<Eigen::Vector3d>& hand_forces_N() const { return hand_forces_N_; }
  const std::vector<presentation_t>& felt() const { return felt_; }

 private:
  struct Hand {
    haptic::Safety safety;
    std::unique_ptr<haptic::Session> session;
    std::int64_t seq = 0;
    sync::EventInbox events{kRun};
  };
  void publish();
  template <class Message, class Deliver>
  void collect(const char* channel, sync::Queue<Message>& queue, Deliver&& deliver);
  void note(const char* channel, std::span<const std::uint8_t> bytes);

  scene_t scene_;
  sim::Simulation simulation_;
  sync::Bus bus_;
  sync::Queue<touch_model_t>& touch_;
  sync::Queue<contact_events_t>& events_;
  sync::Queue<contact_frame_t>& contacts_;
  sync::Queue<world_state_t>& bodies_;
  sim::Publisher publisher_;
  std::unique_ptr<sync::LogWriter> log_;
  std::vector<std::unique_ptr<Hand>> hands_;
  std::vector<tool_state_t> news_;
  std::vector<Eigen::Vector3d> hand_forces_N_;
  std::vector<presentation_t> felt_;
  double step_us_ = 0;
};

}  // namespace tactus::bench
