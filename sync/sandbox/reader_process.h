// Runs a reader program: a separate confined process that parses a foreign file and returns its content.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "sync/sandbox/records.h"

namespace tactus::sync {

struct ReaderLimits {
  // Of all records together; of a ReaderSession: of one answer.
  std::size_t max_bytes = std::size_t{512} << 20;
  // Longer than the processor time that a reader may use (sandbox.h), so that only a process that waits reaches it.
  std::chrono::seconds timeout{600};
  // From the end of its output to its own end; then it is killed.
  std::chrono::milliseconds grace{5000};
};

struct ReaderOutput {
  std::vector<Record> records;  // complete ones only
  std::string failure;          // one clause; empty: the reader ended normally
};

// Starts `program`, which lies in the folder of this program (or in the folder TACTUS_BIN), and waits for its end. The
// process has an empty environment, no open file of this process, and normal scheduling. Not for a real-time thread.
// Throws std::runtime_error with one sentence when the program is missing.
ReaderOutput run_reader(const std::string& program, const std::vector<std::string>& arguments,
                        const ReaderLimits& limits = {});

// The text of a record 'E' on one line of at most 400 characters: the reader may be under the control of the file.
std::string text_of(const Record& record);

// The content of its only record. Throws std::runtime_error with one clause: that of the reader, or why it ended.
std::vector<std::uint8_t> read_in_process(const std::string& program, const std::vector<std::string>& arguments,
                                          const ReaderLimits& limits = {});

// The content of a record 'R'. Throws std::runtime_error with the text of another one.
std::vector<std::uint8_t> content_of(Record record);

// Why a reader was ended, in one clause.
inline constexpr const char* kReaderTimeout = "it takes too long to read: simplify it";
inline constexpr const char* kReaderEndedEarly = "its reader ended too early: the file is damaged or hostile; export it again";
std::string too_much_content(std::size_t max_bytes);

}  // namespace tactus::sync
