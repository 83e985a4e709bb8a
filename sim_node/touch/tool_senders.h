// The one sender of each tool: which TOOL_STATE messages move the world. A second haptic process of the same tool, a
// recorded one and a repeated message change nothing. Pure.
#pragma once

#include <string>
#include <tactus/tool_def_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <vector>

#include "sync/clocks/single_sender.h"
#include "sync/time/time.h"

namespace tactus::sim {

class ToolSenders {
 public:
  // tools: of the scene. run_id: of this simulation; messages of other runs are ignored.
  ToolSenders(const std::vector<tool_def_t>& tools, std::int64_t run_id);

  // Whether a message is used: the next one of the followed sender of its tool. arrival: on the own clock, never
  // decreasing. Realtime-safe: yes.
  bool accept(const tool_state_t& message, sync::HostTime arrival);
  // One sentence that names the tools with two senders; empty: there is none.
  std::string conflict_text(sync::HostTime now) const;

 private:
  struct Tool {
    std::string name;
    sync::SingleSender sender;
  };
  std::vector<Tool> tools_;
};

}  // namespace tactus::sim
