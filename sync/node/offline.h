// A recorded log as the input instead of the bus: the part of --log that all renderers share. The loop is the live one
// (sync/node/run_renderer.h); sync/node/tick_source.h takes its ticks from here.
//
// All times are times of the log, except the parameters `clock`, which are times of the machine that renders it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tactus/presentation_t.hpp>
#include <vector>

#include "sync/log/log_feed.h"
#include "sync/node/node_options.h"
#include "sync/text/atomic_file.h"
#include "sync/text/printable.h"

namespace tactus::sync {

struct OfflineOptions {
  std::string log;           // empty: live
  int run = 1;               // its number in a log with several
  std::string presented;     // table of the outcome of each event; empty: none
  bool as_recorded = false;  // true: the profiles of the run apply; false: only the profile of --degrade applies

  // does: the use of the log, e.g. "draws this log of a run". output: the option that names the output file.
  void add_to(Arguments& app, const std::string& does, const std::string& output);
};

class OfflineInput {
 public:
  // An output file and the option that names it, e.g. {"sound.wav", "--wav"}.
  struct Written {
    std::string path, option;
  };

  // tail: time that is rendered after the end of the log. Throws std::runtime_error with one sentence when the log holds
  // no run, or when an output file would overwrite the log.
  OfflineInput(const OfflineOptions& options, std::vector<Written> written, double rate_Hz, HostTime clock,
          Nanoseconds tail = Nanoseconds(0));

  // Adapts the options of a node to the run of the log. `--degrade logged` uses the profiles of the run.
  void adapt(NodeOptions& options);
  const LogFeed& feed() const { return feed_; }
  // Its number in the log.
  int run_number() const { return run_number_; }
  // A sentence about the log, with its name.
  std::string refusal(const std::string& reason) const { return printable(log_) + ": " + reason; }
  // Of a log that held no scene until its end.
  std::string no_scene() const { return refusal("the log has no scene; give one that scripts/run wrote from its beginning"); }
  // The next tick of the log.
  HostTime next(Bus& bus);
  // Sets the time of the next tick, instead of one period after the last.
  void set_next_tick(HostTime at) { next_tick_ = at; }
  HostTime now() const { return now_; }
  bool over() const { return now_ >= end_ + delay_; }
  // Ends the rendering at this time, because there is nothing more to do.
  void end_at(HostTime end) { end_ = end, delay_ = Nanoseconds(0); }
  // The delay with which the output follows the log: it is rendered for this longer, so that its last events are presented.
  void set_delay(Nanoseconds delay) { delay_ = delay; }
  // Throws std::runtime_error with one sentence when the rate of the ticks differs from the rate that the scene requires.
  void require_rate(double rate_Hz) const;
  // Adds the outcome of an event to the table of outcomes.
  void record_outcome(const std::string& modality, const presentation_t& report);

  // A progress line for the user, once a second.
  std::optional<std::string> progress(HostTime clock);
  // Renames all files to their final names; call it when the log is over. Returns the time taken and the damage of the log,
  // to be appended to the summary of the output. Throws std::runtime_error with one sentence when the log is not over.
  std::string finish(double rendered_s, HostTime clock);

 private:
  std::string log_;
  LogFeed feed_;
  int run_number_;
  double rate_Hz_;
  bool as_recorded_;
  std::unique_ptr<AtomicFile> presented_;
  HostTime end_, now_, started_, last_progress_;
  Nanoseconds delay_{0};
  std::optional<HostTime> next_tick_;
};

// Options of a renderer whose output is a table.
struct OfflineTableOptions : OfflineOptions {
  std::string trace;  // path of the CSV table

  // quantity: in the table, e.g. "force". columns: the exported table with the same columns, e.g. "haptic.csv".
  void add_to(Arguments& app, const std::string& quantity, const std::string& columns);
};

// A recorded run and its output, a table with one row per tick.
class OfflineTable {
 public:
  // Throws std::runtime_error with one sentence when the log holds no run or the table cannot be written.
  OfflineTable(const OfflineTableOptions& options, const std::string& names, double rate_Hz, HostTime clock);

  OfflineInput& run() { return run_; }
  // Adds the row of this tick.
  void add_row(const std::string& row);
  // Renames the table to its final name and returns a summary in lines. Throws std::runtime_error with one sentence, the
  // problem, when there is no row.
  std::string result(const std::string& problem, HostTime clock);

 private:
  OfflineInput run_;
  AtomicFile table_;
  std::optional<HostTime> first_;  // tick of the first row
  std::int64_t rows_ = 0;
};

}  // namespace tactus::sync
