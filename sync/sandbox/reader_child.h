// Starts a reader program as a child process, and waits for it. For run_reader and ReaderSession.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

namespace tactus::sync {

// A running reader program. The destructor kills it unless it was waited for. The process ends with the thread that started it.
class ReaderChild {
 public:
  // Starts `program`, which lies in the folder of this program (or in the folder TACTUS_BIN), with an empty environment, normal
  // scheduling, and no open files but these: input (-1: none) and output. Throws std::runtime_error with one sentence.
  ReaderChild(const std::string& program, const std::vector<std::string>& arguments, int input, int output);
  ~ReaderChild();
  ReaderChild(const ReaderChild&) = delete;
  ReaderChild& operator=(const ReaderChild&) = delete;

  // Waits for its end, and kills it after this time: a hostile reader may close its output and wait. Returns why it ended, in
  // one clause; empty: normally.
  std::string wait(std::chrono::milliseconds longest);
  // Kills it.
  void end();

 private:
  pid_t id_ = -1;
};

}  // namespace tactus::sync
