#include "sim_node/command/command_queue.h"

namespace tactus::sim {
namespace {

int cost_of(const sim_command_t& c) {
  const bool copies_state = c.kind == sim_command_t::RESET || c.kind == sim_command_t::SNAPSHOT || c.kind == sim_command_t::RESTORE;
  return copies_state ? kMaxCommandsPerTick : 1;
}

}  // namespace

void execute_commands(sync::Queue<sim_command_t>& commands, Commander& commander, std::int64_t run_id) {
  for (int left = kMaxCommandsPerTick; left > 0;) {
    const auto m = commands.pop();
    if (!m) return;
    if (m->message.header.run_id != run_id) continue;
    commander.execute(m->message);
    left -= cost_of(m->message);
  }
}

}  // namespace tactus::sim
