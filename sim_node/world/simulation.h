// The world, one step at a time: forces of the tools, the solver, the contacts, the surfaces near the tools. Pure: what
// the tools say is an argument, what there is to publish the result.
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
  std::int64_t steps = 0;  // still to act
};

class Simulation {
 public:
  static constexpr std::size_t kMaxWrenches = 64;

  // Throws std::runtime_error with one sentence when the world cannot be simulated.
  Simulation(const WorldDef& world, const Settings& settings);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;
  // The world at its first instant. incarnation: of the process; prefixes the ids of events and contacts. Call once,
  // before the first step, which also gives the events of this instant.
  void start(std::int64_t incarnation);

  // All of the world's state, as bytes of the form of sim_node/model/envelope.h.
  std::vector<std::uint8_t> save();
  // Puts a state back: what follows is the same to the bit, in this process or another of the same build. Returns why
  // not, in one sentence, when the bytes are damaged or not of this world; then nothing has changed. Empty: it is done.
  std::string restore(std::span<const std::uint8_t> bytes);
  // The world as it was at start().
  void reset() { restore(begin_); }
  // A world that was put back lives anew under another incarnation: its contacts go on under new ids, and what the hands
  // said before is forgotten, since they are where they are.
  void begin_life(std::int64_t incarnation);

  // In place of a step while the world stands still: hands feel the surfaces where they are, bodies do not yield, and
  // everything is published at rest. tools: as for step().
  void hold(std::span<const tool_state_t> tools);

  // Advances by one step. tools: all TOOL_STATE messages since the last call, in order of arrival.
  // Deterministic: the same messages give the same world to the bit.
  void step(std::span<const tool_state_t> tools);

  sync::SimTime now() const { return sync::SimTime(step_ * steps_); }
  sync::Nanoseconds step_length() const { return step_; }

  // After a step: what became known in it, and the present state.
  const std::vector<contact_event_t>& events() const { return events_; }
  std::vector<touch_model_t>& touch_models() { return models_; }
  const std::vector<contact_t>& tool_contacts() const { return tool_contacts_; }
  // Contacts between bodies at the present instant, into `out`, which is cleared.
  void body_contacts(std::vector<contact_t>& out) { mechanics_->contacts(out); }
  std::span<const BodyMotion> bodies() const {
    return held_ ? std::span<const BodyMotion>(shown_) : mechanics_->motions();
  }
  // Of the bodies that are computed ahead; null: none are.
  const Ahead* ahead() { return mechanics_->ahead(); }
  Game& game() { return game_; }
  // To set what may be set while the world runs. Of friction the tools are told here.
  Mechanics& mechanics() { return *mechanics_; }
  const Mechanics& mechanics() const { return *mechanics_; }
  // Of a world in one group; throws std::bad_cast when it is in two.
  const Solver& solver() const { return dynamic_cast<const SingleGroup&>(*mechanics_).solver(); }
  void set_friction(int body, double friction);
  // A force and a torque, world frame, on a body at its centre of mass, for so long from the next step on. False: as many
  // act already as there may be.
  bool push(const Wrench& wrench);
  std::size_t wrenches() const { return wrenches_.size(); }

 private:
  struct Tool {
    int body = -1;
    ToolTouch touch;
    ToolPush push;
    std::vector<tool_state_t> news;
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  };
  void detect_contacts();
  void take_model(std::size_t tool);
  void place_tools(std::span<BodyMotion> motions);
  void find_tools();
  void sort_news(std::span<const tool_state_t> messages);
  void apply_wrenches();
  void archive(StateArchive& a);

  Settings settings_;
  sync::Nanoseconds step_;
  std::int64_t steps_ = 0;
  Ids ids_;
  std::shared_ptr<MeshTrees> trees_;
  std::unique_ptr<Mechanics> mechanics_;
  std::vector<Tool> tools_;
  std::vector<GroupTool> group_tools_;
  std::vector<BodyMotion> shown_;  // while it stands still: all at rest
  std::vector<contact_event_t> events_;
  std::vector<contact_t> tool_contacts_;
  std::vector<touch_model_t> models_;
  std::vector<Wrench> wrenches_;
  Game game_;
  bool held_ = false;  // shown_ is what is shown
  std::uint64_t fingerprint_;
  std::vector<std::uint8_t> begin_;  // the state at start()
};

}  // namespace tactus::sim
