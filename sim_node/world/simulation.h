// The world, one step at a time: forces of the tools, solver, contacts, and the surfaces near the tools. Pure: tool
// messages are arguments, and the data to publish are results.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <vector>

#include "sim_node/behaviour/single_group.h"
#include "sim_node/touch/tool_push.h"
#include "sim_node/touch/tool_touch.h"
#include "sim_node/model/ids.h"
#include "sim_node/game/game.h"
#include "sync/time/time.h"

namespace tactus::sim {

struct Wrench {
  int body = -1;
  Eigen::Vector3d force_N{0, 0, 0}, torque_N_m{0, 0, 0};
  std::int64_t steps = 0;  // remaining duration
};

class Simulation {
 public:
  static constexpr std::size_t kMaxWrenches = 64;

  // Throws std::runtime_error with one sentence when the world cannot be simulated.
  Simulation(const WorldDef& world, const Settings& settings);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;
  // Starts the world at its first instant. incarnation: of the process; prefixes the ids of events and contacts. Call
  // once before the first step; that step also returns the events of this instant. Throws as step().
  void start(std::int64_t incarnation);

  // The whole state of the world as bytes in the format of sim_node/model/envelope.h. Throws as step().
  std::vector<std::uint8_t> save();
  // Restores a state; the continuation is identical to the bit, in this process or another one of the same build.
  // Returns an error sentence when the bytes are damaged or belong to another world, and then changes nothing. Empty:
  // success. Throws as step().
  std::string restore(std::span<const std::uint8_t> bytes);
  // Restores the state at start().
  void reset() { restore(begin_); }
  // Call after restore(): starts a new incarnation. Contacts continue under new ids, and tool messages of the old
  // incarnation are dropped, because the tools stay at their current poses. Throws as step().
  void begin_incarnation(std::int64_t incarnation);

  // Replaces step() while the world is paused: tools touch the surfaces at their current poses, bodies do not yield,
  // and everything is published at rest. tools: as for step().
  void hold(std::span<const tool_state_t> tools);

  // Advances by one step. tools: all TOOL_STATE messages since the last call, in order of arrival.
  // Deterministic: the same messages give the same world to the bit. Throws std::runtime_error with one sentence, which names
  // the body and the step, when a state is not finite; the world cannot continue then.
  void step(std::span<const tool_state_t> tools);

  sync::SimTime now() const { return sync::SimTime(step_ * steps_); }
  sync::Nanoseconds step_length() const { return step_; }

  // Valid after a step: the events detected in it, and the current state.
  const std::vector<contact_event_t>& events() const { return events_; }
  std::vector<touch_model_t>& touch_models() { return models_; }
  const std::vector<contact_t>& tool_contacts() const { return tool_contacts_; }
  // Contacts between bodies at the present instant; clears `out` first.
  void body_contacts(std::vector<contact_t>& out) { mechanics_->contacts(out); }
  std::span<const BodyMotion> bodies() const {
    return held_ ? std::span<const BodyMotion>(held_motions_) : mechanics_->motions();
  }
  // Bodies that are computed ahead; null: none.
  const LookAhead* look_ahead() { return mechanics_->look_ahead(); }
  Game& game() { return game_; }
  // Access for changes at run time. Set friction with set_friction(), which also updates the tools.
  Mechanics& mechanics() { return *mechanics_; }
  const Mechanics& mechanics() const { return *mechanics_; }
  // For a world in one group; throws std::bad_cast when it has two.
  const Solver& solver() const { return dynamic_cast<const SingleGroup&>(*mechanics_).solver(); }
  void set_friction(int body, double friction);
  // Applies a force and a torque, world frame, to a body at its centre of mass from the next step on. False:
  // kMaxWrenches are active already.
  bool push(const Wrench& wrench);
  std::size_t wrenches() const { return wrenches_.size(); }

 private:
  struct Tool {
    int body = -1;
    ToolTouch touch;
    ToolPush push;
    std::vector<tool_state_t> new_messages;
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  };
  void detect_contacts();
  void update_model(std::size_t tool);
  void place_tools(std::span<BodyMotion> motions);
  void collect_group_tools();
  void sort_messages(std::span<const tool_state_t> messages);
  void apply_wrenches();
  void archive(StateArchive& a);
  void require_finite();
  [[noreturn]] void stop_at(int body, const char* quantity) const;

  Settings settings_;
  sync::Nanoseconds step_;
  std::int64_t steps_ = 0;
  std::vector<std::string> names_;  // of the bodies
  Ids ids_;
  std::shared_ptr<MeshTrees> trees_;
  std::unique_ptr<Mechanics> mechanics_;
  std::vector<Tool> tools_;
  std::vector<GroupTool> group_tools_;
  std::vector<BodyMotion> held_motions_;  // while paused: all bodies at rest
  std::vector<contact_event_t> events_;
  std::vector<contact_t> tool_contacts_;
  std::vector<touch_model_t> models_;
  std::vector<Wrench> wrenches_;
  Game game_;
  bool held_ = false;  // bodies() returns held_motions_
  std::uint64_t fingerprint_;
  std::vector<std::uint8_t> begin_;  // state at start()
};

}  // namespace tactus::sim
