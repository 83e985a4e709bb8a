// A recorded run in place of the bus: the part of --log that all renderers share. The loop is the one that runs live
// (sync/node/run_renderer.h); sync/node/tick_source.h takes its ticks from here.
//
// All times but `clock`, that of whoever looks on, are the log's.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tactus/presentation_t.hpp>
#include <vector>

#include "sync/log/log_feed.h"
#include "sync/node/node.h"
#include "sync/text/atomic_file.h"

namespace tactus::sync {

struct OfflineOptions {
  std::string log;           // empty: live
  std::string presented;     // table of what became of each event; empty: none
  bool as_recorded = false;  // the profiles of the run hold; else only what --degrade names

  // does: what becomes of the log, e.g. "draws this log of a run"; output: the option that names the file it goes
  // to.
  void add_to(CLI::App& app, const std::string& does, const std::string& output);
};

class Offline {
 public:
  // A file that is written and the option that names it, e.g. {"sound.wav", "--wav"}.
  struct Written {
    std::string path, option;
  };

  // rings_on: so much longer than the log it goes on. Throws std::runtime_error with one sentence when the log
  // holds no run, or what is written would lie where the log is.
  Offline(const OfflineOptions& options, std::vector<Written> written, double rate_Hz, HostTime clock,
          Nanoseconds rings_on = Nanoseconds(0));

  // What a node needs to take part in the run of the log. `--degrade logged` takes the profiles of the run.
  void adapt(NodeOptions& options);
  const LogFeed& feed() const { return feed_; }
  // The next tick of the log.
  HostTime next(Bus& bus);
  // The next tick is at this time, and not one period after the last.
  void set_next_tick(HostTime at) { next_tick_ = at; }
  HostTime now() const { return now_; }
  bool over() const { return now_ >= end_; }
  // It is over at this time already, for there is nothing more to do.
  void end_at(HostTime end) { end_ = end; }
  // Throws std::runtime_error with one sentence when the ticks come at another rate than the scene asks for.
  void expect_rate(double rate_Hz) const;
  // What became of an event, to the table of those.
  void note(const std::string& modality, const presentation_t& report);

  // Once a second a line for people.
  std::optional<std::string> progress(HostTime clock);
  // All files get their names; call when the log is over. How long it took and what of the log was damaged, to be
  // appended to what came of it. Throws std::runtime_error with one sentence when the log is not over.
  std::string finish(double rendered_s, HostTime clock);

 private:
  LogFeed feed_;
  double rate_Hz_;
  bool as_recorded_;
  std::unique_ptr<AtomicFile> presented_;
  HostTime end_, now_, began_, said_;
  std::optional<HostTime> next_tick_;
};

}  // namespace tactus::sync
