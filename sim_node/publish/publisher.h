// Publishes a step of the world in the order that receivers require: touch models, contact events, contacts of tools,
// then the due pages of the slow state.
#pragma once

#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/sim_clock_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <vector>

#include "sim_node/game/game.h"
#include "sim_node/publish/snapshots.h"
#include "sim_node/publish/event_repeater.h"
#include "sync/time/time.h"

namespace tactus::sync {
class Bus;
}

namespace tactus::sim {

// The data of a step to publish.
struct StepView {
  sync::SimTime time{};
  std::vector<touch_model_t>* touch_models = nullptr;          // one per tool, complete; stamped and paged here
  const std::vector<contact_event_t>* events = nullptr;        // detected in this step
  const std::vector<contact_t>* tool_contacts = nullptr;
  StateSource state;
  Game* game = nullptr;  // null: the scene has no game
};

class Publisher {
 public:
  Publisher(sync::Bus& bus, double state_rate_Hz, double pages_per_second, std::size_t event_pages, sync::Nanoseconds step)
      : bus_(bus), step_(step), repeater_(event_pages), snapshots_(state_rate_Hz, pages_per_second, step) {}

  void publish(const StepView& view, const sync::TimeMap& map);
  // A new receiver has appeared: publishes every body as soon as the budget allows.
  void request_full_state() { snapshots_.request_full(); }

 private:
  void publish_events(const StepView& view, const sim_clock_t& clock);
  void publish_tool_contacts(const StepView& view, const sim_clock_t& clock);
  void publish_game(const StepView& view, const sim_clock_t& clock);

  static constexpr int kGameTicks = 250;  // 4 Hz, for receivers that join late or missed a change

  sync::Bus& bus_;
  sync::Nanoseconds step_;
  // Simulated time, plus one step for every tick of a pause; initially before both.
  sync::SimTime pace_{-std::chrono::hours(1)};
  int game_ticks_ = 0;  // since the last publication
  touch_model_t touch_page_{};
  EventRepeater repeater_;
  Snapshots snapshots_;
};

}  // namespace tactus::sim
