#include "sync/node/offline.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "sync/log/export_events.h"
#include "sync/log/log_parts.h"

namespace tactus::sync {

void OfflineOptions::add_to(Arguments& app, const std::string& does, const std::string& output) {
  app.add_option("--log", log,
                 does + " instead of the messages on the bus, as fast as possible; needs " + output +
                     "; --degrade logged takes the profiles of the run");
  app.add_option("--run", run, "number of the run, of a log with several").range(1, 1'000'000).needs("--log").show_default();
  app.add_option("--presented", presented, "file for a table of the outcome of each event of the log, CSV").needs("--log");
}

OfflineInput::OfflineInput(const OfflineOptions& options, std::vector<Written> written, double rate_Hz, HostTime clock,
                 Nanoseconds tail)
    : log_(options.log),
      feed_(options.log, rate_Hz, options.run),
      run_number_(options.run),
      rate_Hz_(rate_Hz),
      as_recorded_(options.as_recorded),
      end_(feed_.end() + tail),
      now_(feed_.begin()),
      started_(clock),
      last_progress_(clock) {
  if (!options.presented.empty()) written.push_back({options.presented, "--presented"});
  // The same file may also be named by another path or a link.
  std::error_code none;
  std::vector<std::string> parts = log_parts_in(options.log);
  parts.push_back(options.log);
  for (const Written& w : written)
    for (const std::string& path : {w.path, w.path + ".part"})
      if (std::ranges::any_of(parts, [&](const std::string& part) { return std::filesystem::equivalent(part, path, none); }))
        throw std::runtime_error(path + " is the log itself, which would be lost; choose another " + w.option);
  if (options.presented.empty()) return;
  presented_ = std::make_unique<AtomicFile>(options.presented, "--presented");
  presented_->write(presented_csv_names());
}

void OfflineInput::adapt(NodeOptions& options) {
  options.bus = feed_.bus();
  options.run_id = feed_.run_id();
  options.realtime = "off";
  if (options.degrade == "logged") as_recorded_ = true, options.degrade.clear();
  if (as_recorded_) return;
  feed_.exclude(channels::kDegradation);
  // A profile of the scene is a profile of the run, too.
  if (options.degrade.empty()) options.profile = read_profile("<profile/>", "profile");
}

HostTime OfflineInput::next(Bus& bus) {
  const std::optional<HostTime> at = std::exchange(next_tick_, std::nullopt);
  return now_ = at ? feed_.next_at(bus, *at) : feed_.next(bus);
}

void OfflineInput::require_rate(double rate_Hz) const {
  if (rate_Hz == rate_Hz_) return;
  std::ostringstream text;
  text << printable(log_) << ": the scene of the log requires " << rate_Hz << " ticks per second, not " << rate_Hz_
       << "; give --set rate=" << rate_Hz;
  throw std::runtime_error(text.str());
}

void OfflineInput::record_outcome(const std::string& modality, const presentation_t& report) {
  if (presented_) presented_->write(csv_row(modality, report, run_number_));
}

std::optional<std::string> OfflineInput::progress(HostTime clock) {
  if (clock - last_progress_ < from_seconds(1)) return std::nullopt;
  last_progress_ = clock;
  const double whole_s = to_seconds(end_ - feed_.begin());
  const double share = whole_s > 0 ? to_seconds(now_ - feed_.begin()) / whole_s : 1;
  return std::to_string(std::lround(100 * std::clamp(share, 0.0, 1.0))) + " % of the log";
}

std::string OfflineInput::finish(double rendered_s, HostTime clock) {
  if (!over()) throw std::runtime_error(printable(log_) + ": stopped before the end of the log: no output is kept");
  if (presented_) presented_->finish();
  const double took_s = to_seconds(clock - started_);
  std::ostringstream text;
  text << ", in " << took_s << " s (" << rendered_s / took_s << " times as fast as real time)";
  if (!feed_.recovered().empty()) text << "\n" << feed_.recovered();
  for (const std::string& sentence : feed_.warnings()) text << "\n" << sentence;
  if (feed_.damaged_regions() > 0)
    text << "\nskipped damage of the log: " << feed_.damaged_regions() << " regions, " << feed_.damaged_bytes()
         << " bytes";
  if (feed_.misdated() > 0)
    text << "\n"
         << feed_.misdated()
         << " events have damaged times, far from the others; they were processed with the preceding events";
  return text.str();
}

void OfflineTableOptions::add_to(Arguments& app, const std::string& quantity, const std::string& columns) {
  OfflineOptions::add_to(app, "renders this log of a run", "--trace");
  app.add_option("--trace", trace, "file for the rendered " + quantity + ", CSV with the columns of " + columns).needs("--log");
}

OfflineTable::OfflineTable(const OfflineTableOptions& options, const std::string& names, double rate_Hz, HostTime clock)
    : run_(options, {{options.trace, "--trace"}}, rate_Hz, clock),
      table_(!options.trace.empty() ? options.trace
                                    : throw std::runtime_error("--log needs --trace FILE for the table of the output"),
             "--trace") {
  table_.write(names);
}

void OfflineTable::add_row(const std::string& row) {
  if (!first_) first_ = run_.now();
  table_.write(row);
  ++rows_;
}

std::string OfflineTable::result(const std::string& problem, HostTime clock) {
  if (!first_)
    throw std::runtime_error(problem.empty() ? run_.no_scene() : run_.refusal(problem));
  const double rendered_s = to_seconds(run_.now() - *first_);
  const std::string rest = run_.finish(rendered_s, clock);
  table_.finish();
  std::ostringstream text;
  text << table_.path() << ": " << rows_ << " ticks, " << rendered_s << " s" << rest;
  return text.str();
}

}  // namespace tactus::sync
