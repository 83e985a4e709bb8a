// Executes commands on the running simulation, each command once, and builds the replies. Pure except for the files
// of saved states.
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
  // Number of replies kept for repeated commands.
  static constexpr std::size_t kMaxPastReplies = 256;

  // folder: for the files of saved states. All three arguments must outlive this object.
  Commander(Simulation& simulation, const WorldDef& world, std::filesystem::path folder)
      : simulation_(simulation), world_(world), store_(std::move(folder)) {}

  // Executes a command of this run. A repeated command is replied to again and has no effect.
  void execute(const sim_command_t& command);
  // The replies to send now; also completes finished file operations. Call once per tick.
  std::vector<sim_reply_t>& take_replies();

  // Whether this tick is a step of the world; counts down the requested single steps. False: the world is paused.
  bool step_due();
  bool paused() const { return paused_; }
  // True once after the world was reset or restored: a new incarnation must begin.
  bool take_restart() { return std::exchange(restarted_, false); }

 private:
  struct PendingFile {  // a command that waits for a file
    std::int64_t id = 0;
    bool reads = false;
    std::string name, text;
  };
  // Returns an error sentence; empty: success, and `text` describes the result.
  std::string run_command(const sim_command_t& c, std::string& text);
  std::string snapshot(const sim_command_t& c, std::string& text);
  std::string restore(const sim_command_t& c, std::string& text);
  std::string restore_bytes(std::span<const std::uint8_t> bytes, const std::string& name, std::string& text);
  void reply(std::int64_t id, const std::string& error, const std::string& text);

  Simulation& simulation_;
  const WorldDef& world_;
  StateStore store_;
  bool paused_ = false, restarted_ = false;
  std::int64_t steps_left_ = 0;
  std::deque<sim_reply_t> past_replies_;
  std::optional<PendingFile> pending_;
  std::vector<sim_reply_t> replies_, out_;
};

}  // namespace tactus::sim
