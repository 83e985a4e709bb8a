// The world, one step at a time: forces of the tools, the solver, the contacts, the surfaces near the tools. Pure: what
// the tools say is an argument, what there is to publish the result.
#pragma once

#include <memory>
#include <span>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <vector>

#include "sim_node/behaviour/solver.h"
#include "sim_node/behaviour/tool_push.h"
#include "sim_node/behaviour/tool_touch.h"
#include "sim_node/collision/contact_tracker.h"
#include "sim_node/collision/ids.h"
#include "sync/time.h"

namespace tactus::sim {

class Simulation {
 public:
  // Throws std::runtime_error with one sentence when the world cannot be simulated.
  Simulation(const WorldDef& world, const Settings& settings);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;
  // The world at its first instant. incarnation: of the process; prefixes the ids of events and contacts. Call once,
  // before the first step, which also gives the events of this instant.
  void start(std::int64_t incarnation);

  // Advances by one step. tools: all TOOL_STATE messages since the last call, in order of arrival.
  // Deterministic: the same messages give the same world to the bit.
  void step(std::span<const tool_state_t> tools);

  sync::SimTime now() const { return sync::SimTime(step_ * steps_); }
  sync::Nanoseconds step_length() const { return step_; }

  // After a step: what became known in it, and the present state.
  const std::vector<contact_event_t>& events() const { return events_; }
  std::vector<touch_model_t>& touch_models() { return models_; }
  const std::vector<contact_t>& tool_contacts() const { return tool_contacts_; }
  // Contacts between bodies, into `out`, which is cleared.
  void body_contacts(std::vector<contact_t>& out) const;
  std::span<const BodyMotion> bodies() const { return motions_; }
  const Solver& solver() const { return solver_; }

 private:
  struct Tool {
    int body = -1;
    ToolTouch touch;
    ToolPush push;
    std::vector<tool_state_t> news;
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  };
  void look();
  void place_tools();

  Settings settings_;
  sync::Nanoseconds step_;
  std::int64_t steps_ = 0;
  Ids ids_;
  Solver solver_;
  ContactTracker tracker_;
  std::vector<Tool> tools_;
  std::vector<BodyMotion> motions_;  // of the solver, with the tools where their proxies are
  std::vector<contact_event_t> events_;
  std::vector<contact_t> tool_contacts_;
  std::vector<touch_model_t> models_;
};

}  // namespace tactus::sim
