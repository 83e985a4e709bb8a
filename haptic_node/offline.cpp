#include "haptic_node/offline.h"

#include <CLI/CLI.hpp>
#include <sstream>
#include <stdexcept>

#include "sync/log/export_csv.h"

namespace tactus::haptic {

void OfflineOptions::add_to(CLI::App& app) {
  sync::OfflineOptions::add_to(app, "renders this log of a run", "--trace");
  app.add_option("--trace", trace, "file for the rendered force, CSV with the columns of haptic.csv")
      ->needs("--log");
}

std::unique_ptr<Offline> Offline::open(const OfflineOptions& options, double rate_Hz, sync::HostTime clock) {
  if (options.log.empty()) return nullptr;
  if (options.trace.empty())
    throw std::runtime_error("--log needs --trace FILE for the table of the rendered force");
  return std::make_unique<Offline>(options, rate_Hz, clock);
}

Offline::Offline(const OfflineOptions& options, double rate_Hz, sync::HostTime clock)
    : run_(options, {{options.trace, "--trace"}}, rate_Hz, clock),
      trace_(options.trace, "--trace"),
      track_(run_.feed()) {
  trace_.write(sync::haptic_csv_names());
}

void Offline::follow(int tool) {
  has_tool_ = tool >= 0;
  tick_ = {};
  next_tick_.reset();
  track_.follow(tool);
  if (has_tool_) schedule();
}

void Offline::schedule() {
  next_tick_ = track_.next(run_.now());
  if (next_tick_)
    run_.set_next_tick(next_tick_->at);
  else
    run_.end_at(run_.now());
}

bool Offline::begin_tick(sync::HostTime now) {
  const bool recorded = next_tick_ && next_tick_->at == now;
  tick_ = recorded ? *next_tick_ : RecordedTick{};
  if (recorded) schedule();
  return recorded;
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
    throw std::runtime_error(
        !problem.empty() ? problem
        : has_tool_      ? "the log has no TOOL_STATE of this tool; choose another --tool"
                         : "the log has no scene; give a log that scripts/run wrote from the start of the run");
  const double felt_s = sync::to_seconds(run_.now() - *first_);
  const std::string rest = run_.finish(felt_s, clock);
  trace_.finish();
  std::ostringstream text;
  text << trace_.path() << ": " << rows_ << " ticks, " << felt_s << " s" << rest;
  return text.str();
}

}  // namespace tactus::haptic
