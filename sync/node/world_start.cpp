#include "sync/node/world_start.h"

#include <algorithm>
#include <utility>

namespace tactus::sync {

WorldStart::WorldStart(WorldStartDef def, HostTime now) : def_(std::move(def)), begin_(now) {
  for (const std::string& name : def_.awaited) nodes_[name].reason = "no report yet";
}

void WorldStart::observe(const node_health_t& report) {
  if (report.header.run_id != def_.run_id) return;
  auto node = nodes_.find(report.node);
  if (node == nodes_.end()) {
    if (report.modality.empty() || nodes_.size() >= kMaxNodes) return;
    node = nodes_.try_emplace(report.node).first;
  }
  node->second.ready = report.state != node_health_t::WAITING;
  // A note ends with the scheduling of the process.
  node->second.reason = report.status_text.substr(0, report.status_text.find(';'));
}

bool WorldStart::all_ready() const {
  return std::ranges::all_of(nodes_, [](const auto& node) { return node.second.ready; });
}

bool WorldStart::due(HostTime now) const {
  const Nanoseconds waited = now - begin_;
  return waited >= def_.min_wait && (all_ready() || waited >= def_.min_wait + def_.max_wait);
}

std::string WorldStart::late() const {
  std::string text;
  for (const auto& [name, state] : nodes_) {
    if (state.ready) continue;
    text += (text.empty() ? "" : ", ") + name;
    if (!state.reason.empty()) text += " (" + state.reason + ")";
  }
  return text;
}

}  // namespace tactus::sync
