// Carries out what is asked of the simulation while it runs, each command once, and says what became of it. Pure
// but for the files of kept states.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <vector>

#include "sim_node/world/simulation.h"
#include "sim_node/command/state_store.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim {

class Commander {
 public:
  // Answers of so many commands are remembered, for their repetitions.
  static constexpr std::size_t kRemembered = 256;

  // folder: of the files of kept states. All three outlive this.
  Commander(Simulation& simulation, const WorldDef& world, std::filesystem::path folder)
      : simulation_(simulation), world_(world), store_(std::move(folder)) {}

  // A command of this run. A repetition is answered again and has no effect.
  void take(const sim_command_t& command);
  // What is to be answered now; files that have been read or written are seen to here. Once a tick.
  std::vector<sim_reply_t>& answers();

  // Whether this tick is a step of the world; counts those that were asked for. Else it stands still.
  bool step_due();
  bool paused() const { return paused_; }
  // True once after the world was reset or put back: it lives anew.
  bool take_anew() { return std::exchange(anew_, false); }

 private:
  struct Waiting {  // for a file
    std::int64_t id = 0;
    bool reads = false;
    std::string name, text;
  };
  // Why not; empty: done, and text says what.
  std::string carry_out(const sim_command_t& c, std::string& text);
  std::string snapshot(const sim_command_t& c, std::string& text);
  std::string restore(const sim_command_t& c, std::string& text);
  std::string put_back(std::span<const std::uint8_t> bytes, const std::string& name, std::string& text);
  void answer(std::int64_t id, const std::string& refused, const std::string& text);

  Simulation& simulation_;
  const WorldDef& world_;
  StateStore store_;
  bool paused_ = false, anew_ = false;
  std::int64_t steps_left_ = 0;
  std::deque<sim_reply_t> known_;
  std::optional<Waiting> waiting_;
  std::vector<sim_reply_t> answers_, out_;
};

}  // namespace tactus::sim
