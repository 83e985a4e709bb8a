#include "haptic_node/offline.h"

#include <sstream>
#include <stdexcept>

#include "sync/log/export_csv.h"

namespace tactus::haptic {

Offline::Offline(const OfflineOptions& options, double rate_Hz, sync::HostTime clock)
    : run_(options, {{options.trace, "--trace"}}, rate_Hz, clock),
      trace_(options.trace, "--trace"),
      track_(run_.feed()) {
  trace_.write(sync::haptic_csv_names());
}

void Offline::follow(int tool) {
  follows_ = tool >= 0;
  tick_ = {};
  track_.follow(tool);
  if (!follows_) return;
  coming_ = track_.next(run_.now());
  if (!coming_) run_.end_at(run_.now());
}

sync::HostTime Offline::next(sync::Bus& bus) {
  if (!follows_) return run_.next(bus);
  tick_ = *coming_;
  const sync::HostTime now = run_.next_at(bus, tick_.at);
  coming_ = track_.next(now);
  if (!coming_) run_.end_at(now);
  return now;
}

void Offline::add(const tool_state_t& state) {
  if (!first_) first_ = run_.now();
  tool_state_t row = state;
  row.header.publish_time_ns = tick_.published_ns;
  row.header.seq = tick_.seq;
  trace_.write(sync::csv_row(row));
  ++rows_;
}

std::string Offline::result(const std::string& problem, sync::HostTime clock) {
  if (rows_ == 0)
    throw std::runtime_error(!problem.empty() ? problem
                             : follows_
                                 ? "the log tells nowhere of this tool: nobody held it; choose another --tool"
                                 : "the log has no scene; give one that scripts/run wrote from its beginning");
  const double felt_s = sync::to_seconds(run_.now() - *first_);
  const std::string rest = run_.finish(felt_s, clock);
  trace_.finish();
  std::ostringstream text;
  text << trace_.path() << ": " << rows_ << " ticks, " << felt_s << " s" << rest;
  return text.str();
}

}  // namespace tactus::haptic
