// Starts scripts/run in the folder of the test.
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>

#include "tests/cluster/support/processes.h"

namespace tactus::cluster {

struct RunScript {
  Folder folder;
  Processes processes{folder.path(), 1};

  std::filesystem::path out(const std::string& name = "run") const { return folder.path() / name; }
  void start(std::vector<std::string> options, const std::string& name = "run") {
    std::vector<std::string> command{"env", "TACTUS_BIN=" + programs().string(),
                                     (repository() / "scripts/run").string()};
    command.insert(command.end(), options.begin(), options.end());
    processes.spawn(name, command);
  }
  int finish(double timeout_s, const std::string& name = "run") { return processes.wait_for_exit(name, timeout_s); }
  // Runs a program to its end and returns its output.
  std::string output_of(const std::vector<std::string>& command, int wanted_status = 0) {
    const std::string name = "command" + std::to_string(++commands_);
    processes.spawn(name, command);
    const int status = processes.wait_for_exit(name, 60);
    INFO(command.front() << ": " << processes.output(name));
    CHECK(status == wanted_status);
    return processes.output(name);
  }

 private:
  int commands_ = 0;
};

// Processes of this namespace that have not ended, without the test itself.
inline std::set<int> running_processes() {
  while (waitpid(-1, nullptr, WNOHANG) > 0) {
  }
  std::set<int> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos || std::stoi(name) == getpid()) continue;
    std::ifstream file(entry.path() / "stat");
    std::stringstream text;
    text << file.rdbuf();
    const std::size_t after_name = text.str().rfind(')');
    if (after_name != std::string::npos && text.str()[after_name + 2] != 'Z') found.insert(std::stoi(name));
  }
  return found;
}

// Waits until no process but the test runs; false after timeout_s seconds.
inline bool all_processes_ended(double timeout_s) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  while (!running_processes().empty()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return true;
}

inline std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace tactus::cluster
