// A recorded run in place of the bus: the node renders the log, and what the skin feels goes into a table.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <tactus/thermal_state_t.hpp>

#include "sync/node/offline.h"

namespace tactus::thermal {

struct OfflineOptions : sync::OfflineOptions {
  std::string trace;  // CSV

  void add_to(CLI::App& app);
};

// All times but `clock`, that of whoever looks on, are the log's.
class Offline {
 public:
  // Throws std::runtime_error with one sentence when the log holds no run or the table cannot be written.
  Offline(const OfflineOptions& options, double rate_Hz, sync::HostTime clock);
  // The same where a log is asked for; else null.
  static std::unique_ptr<Offline> open(const OfflineOptions& options, double rate_Hz, sync::HostTime clock);

  sync::Offline& run() { return run_; }
  // What the skin feels in this tick.
  void add(const thermal_state_t& state);
  // The table gets its name. What came of it, in lines. Throws std::runtime_error with one sentence when there was
  // nothing to feel; problem: why.
  std::string result(const std::string& problem, sync::HostTime clock);

 private:
  sync::Offline run_;
  sync::AtomicFile trace_;
  double period_s_;
  std::int64_t rows_ = 0;
};

}  // namespace tactus::thermal
