#include "haptic_node/offline.h"

#include "sync/log/export_csv.h"

namespace tactus::haptic {

Offline::Offline(const sync::OfflineTableOptions& options, double rate_Hz, sync::HostTime clock)
    : OfflineTable(options, sync::haptic_csv_names(), rate_Hz, clock), track_(run().feed()) {}

void Offline::follow(int tool) {
  has_tool_ = tool >= 0;
  tick_ = {};
  next_tick_.reset();
  track_.follow(tool);
  if (has_tool_) schedule();
}

void Offline::schedule() {
  next_tick_ = track_.next(run().now());
  if (next_tick_)
    run().set_next_tick(next_tick_->at);
  else
    run().end_at(run().now());
}

bool Offline::begin_tick(sync::HostTime now) {
  const bool recorded = next_tick_ && next_tick_->at == now;
  tick_ = recorded ? *next_tick_ : RecordedTick{};
  if (recorded) schedule();
  return recorded;
}

void Offline::add(const tool_state_t& state) {
  tool_state_t row = state;
  row.header.publish_time_ns = tick_.published_ns;
  row.header.seq = tick_.seq;
  add_row(sync::csv_row(row, run().run_number()));
}

std::string Offline::result(const std::string& problem, sync::HostTime clock) {
  const bool no_tick = problem.empty() && has_tool_;
  return OfflineTable::result(no_tick ? "the log has no TOOL_STATE of this tool; choose another --tool" : problem, clock);
}

}  // namespace tactus::haptic
