// Sends a step of the world, in the order that receivers rely on: the touch models, the contact events, the contacts of
// tools, then the pages of slow state that are due.
#pragma once

#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/sim_clock_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <vector>

#include "sim_node/game/game.h"
#include "sim_node/publish/snapshots.h"
#include "sim_node/publish/event_repeater.h"
#include "sync/bus/bus.h"

namespace tactus::sim {

// What a step has to say.
struct StepView {
  sync::SimTime time{};
  std::vector<touch_model_t>* touch_models = nullptr;          // one per tool, whole; stamped and cut into pages here
  const std::vector<contact_event_t>* events = nullptr;        // that became known in this step
  const std::vector<contact_t>* tool_contacts = nullptr;
  StateSource state;
  Game* game = nullptr;  // null: the scene has none
};

class Publisher {
 public:
  Publisher(sync::Bus& bus, double state_rate_Hz, double pages_per_second, std::size_t event_pages, sync::Nanoseconds step)
      : bus_(bus), step_(step), young_(event_pages), snapshots_(state_rate_Hz, pages_per_second, step) {}

  void publish(const StepView& view, const sync::TimeMap& map);
  // Somebody new is listening: every body goes out as soon as the budget allows.
  void request_full_state() { snapshots_.want_full(); }

 private:
  void publish_events(const StepView& view, const sim_clock_t& clock);
  void publish_tool_contacts(const StepView& view, const sim_clock_t& clock);
  void publish_game(const StepView& view, const sim_clock_t& clock);

  static constexpr int kGameTicks = 250;  // 4 Hz for who joins late or missed a change

  sync::Bus& bus_;
  sync::Nanoseconds step_;
  // The world's time, and a step for every tick in which it stands still; before the first of either.
  sync::SimTime pace_{-std::chrono::hours(1)};
  int game_ticks_ = 0;  // since it was told last
  touch_model_t touch_page_{};
  EventRepeater young_;
  Snapshots snapshots_;
};

}  // namespace tactus::sim
