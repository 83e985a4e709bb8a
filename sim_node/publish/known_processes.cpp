#include "sim_node/publish/known_processes.h"

namespace tactus::sim {

bool KnownProcesses::is_new(const node_health_t& m, sync::HostTime arrival) {
  if (m.header.run_id != run_id_ || own_.find(m.header.incarnation)) return false;
  // Only a simulation reports a real-time factor. A paused one has the factor 0, and usually the same name.
  if (m.node == name_ || m.realtime_factor > 0) last_other_ = arrival;
  return known_.try_emplace(m.header.incarnation).second;
}

std::string KnownProcesses::conflict_text(sync::HostTime now) const {
  if (!last_other_ || now - *last_other_ >= kSilence) return "";
  return "another simulation of this run sends; stop one of them";
}

}  // namespace tactus::sim
