#include "thermal_node/offline.h"

#include <CLI/CLI.hpp>
#include <sstream>
#include <stdexcept>

#include "sync/log/export_csv.h"

namespace tactus::thermal {

void OfflineOptions::add_to(CLI::App& app) {
  sync::OfflineOptions::add_to(app, "renders this log of a run", "--trace");
  app.add_option("--trace", trace, "file for the rendered temperature, CSV with the columns of thermal.csv")
      ->needs("--log");
}

std::unique_ptr<Offline> Offline::open(const OfflineOptions& options, double rate_Hz, sync::HostTime clock) {
  if (options.log.empty()) return nullptr;
  if (options.trace.empty())
    throw std::runtime_error("--log needs --trace FILE for the table of the rendered temperature");
  return std::make_unique<Offline>(options, rate_Hz, clock);
}

Offline::Offline(const OfflineOptions& options, double rate_Hz, sync::HostTime clock)
    : run_(options, {{options.trace, "--trace"}}, rate_Hz, clock),
      trace_(options.trace, "--trace"),
      period_s_(1 / rate_Hz) {
  trace_.write(sync::thermal_csv_names());
}

void Offline::add(const thermal_state_t& state) {
  thermal_state_t row = state;
  row.header.publish_time_ns = sync::to_ns(run_.now());
  trace_.write(sync::csv_row(row));
  ++rows_;
}

std::string Offline::result(const std::string& problem, sync::HostTime clock) {
  if (rows_ == 0)
    throw std::runtime_error(
        problem.empty() ? "the log has no scene; give a log that scripts/run wrote from the start of the run"
                        : problem);
  const double felt_s = static_cast<double>(rows_) * period_s_;
  const std::string rest = run_.finish(felt_s, clock);
  trace_.finish();
  std::ostringstream text;
  text << trace_.path() << ": " << rows_ << " ticks, " << felt_s << " s" << rest;
  return text.str();
}

}  // namespace tactus::thermal
