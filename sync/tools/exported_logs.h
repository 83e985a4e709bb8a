// The logs that a program makes tables of, read as one: its options, and its warnings.
#pragma once

#include <string>
#include <vector>

#include "sync/log/log_index.h"
#include "sync/log/mapped_log.h"
#include "sync/node/node_options.h"
#include "sync/tools/log_interval.h"

namespace tactus::sync {

struct ExportedLogOptions {
  std::vector<std::string> logs;
  int run = 0;  // number of the only run, from 1; 0: all
  LogInterval interval;  // the messages that the tables hold
  bool quiet = false;

  void add_to(Arguments& app);
};

class ExportedLogs {
 public:
  // Prints the warnings about the logs to stderr, after the name of the program. Throws std::runtime_error with one sentence when
  // a log cannot be read, has no such run, or when the interval ends before it begins.
  ExportedLogs(const ExportedLogOptions& options, const std::string& program);

  const LogIndex& index() const { return index_; }
  // Numbers of the chosen runs.
  std::vector<int> runs() const;

 private:
  int run_;
  MappedLog file_;
  LogIndex index_;
};

}  // namespace tactus::sync
