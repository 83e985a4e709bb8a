// The commands of one tick.
#pragma once

#include <cstdint>
#include <tactus/sim_command_t.hpp>

#include "sim_node/command/commander.h"
#include "sync/bus/inbox.h"

namespace tactus::sim {

// Bounds the time that commands take from a step; a sender without a reply repeats its command. A command that copies the whole
// state takes all of it.
inline constexpr int kMaxCommandsPerTick = 4;

// Executes the next commands of this run, at most kMaxCommandsPerTick. Those of other runs cost nothing, so they delay none.
void execute_commands(sync::Queue<sim_command_t>& commands, Commander& commander, std::int64_t run_id);

}  // namespace tactus::sim
