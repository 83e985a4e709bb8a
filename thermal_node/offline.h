// Renders a recorded run (--log) instead of the bus; the rendered skin state goes into a table.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <tactus/thermal_state_t.hpp>

#include "sync/node/offline.h"

namespace tactus::thermal {

struct OfflineOptions : sync::OfflineOptions {
  std::string trace;  // path of the CSV table

  void add_to(CLI::App& app);
};

// All times are times of the log, except `clock`, which is this host's clock.
class Offline {
 public:
  // Throws std::runtime_error with one sentence when the log holds no run or the table cannot be written.
  Offline(const OfflineOptions& options, double rate_Hz, sync::HostTime clock);
  // Like the constructor when --log is given; returns null otherwise.
  static std::unique_ptr<Offline> open(const OfflineOptions& options, double rate_Hz, sync::HostTime clock);

  sync::OfflineInput& run() { return run_; }
  // Adds the state of this tick to the table.
  void add(const thermal_state_t& state);
  // Renames the table to its final name and returns a summary in lines. Throws std::runtime_error with one
  // sentence when there was no tick; problem: the reason.
  std::string result(const std::string& problem, sync::HostTime clock);

 private:
  sync::OfflineInput run_;
  sync::AtomicFile trace_;
  double period_s_;
  std::int64_t rows_ = 0;
};

}  // namespace tactus::thermal
