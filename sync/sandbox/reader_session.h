// A reader program that parses several foreign files, one after another, in one confined process: starting a process for
// each file would take longer than parsing most of them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sync/sandbox/reader_process.h"

namespace tactus::sync {

class ReaderSession {
 public:
  // After this number of processes that ended badly, no further one is started.
  static constexpr int kMaxFailures = 4;

  // program, arguments, limits: as of run_reader. The process starts with the first request.
  ReaderSession(std::string program, std::vector<std::string> arguments, const ReaderLimits& limits = {});
  ~ReaderSession();
  ReaderSession(const ReaderSession&) = delete;
  ReaderSession& operator=(const ReaderSession&) = delete;

  // Sends the bytes of one file, or what else the program expects, and waits for the answer: the content of a record 'R'.
  // Throws std::runtime_error with one clause: that of the reader, or why it ended. A process that ended or answered too much
  // is replaced at the next request, so that one hostile file costs no other one. Call it on one thread, which must not be
  // a real-time thread. Thread-safe: no.
  std::vector<std::uint8_t> request(std::span<const std::uint8_t> content);

  // Number of processes that were started.
  int started() const { return started_; }

 private:
  struct Process;
  std::vector<std::uint8_t> exchange(std::span<const std::uint8_t> content);

  std::string program_;
  std::vector<std::string> arguments_;
  ReaderLimits limits_;
  std::unique_ptr<Process> process_;
  int started_ = 0, failures_ = 0;
};

}  // namespace tactus::sync
