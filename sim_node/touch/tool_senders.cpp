#include "sim_node/touch/tool_senders.h"

namespace tactus::sim {

ToolSenders::ToolSenders(const std::vector<tool_def_t>& tools, std::int64_t run_id) {
  for (const tool_def_t& tool : tools) tools_.push_back({tool.name, sync::SingleSender(run_id)});
}

bool ToolSenders::accept(const tool_state_t& m, sync::HostTime arrival) {
  const auto tool = static_cast<std::size_t>(m.tool);
  return tool < tools_.size() && sync::accepted(tools_[tool].sender.on_message(m.header, arrival));
}

std::string ToolSenders::conflict_text(sync::HostTime now) const {
  std::string names;
  for (const Tool& tool : tools_)
    if (tool.sender.conflict(now)) names += (names.empty() ? "\"" : "\", \"") + tool.name;
  return names.empty() ? "" : "two haptic processes hold the tool " + names + "\"; the first one counts, stop the other";
}

}  // namespace tactus::sim
