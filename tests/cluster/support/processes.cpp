// Start, signals and output of the processes of a test.
#include "tests/cluster/support/processes.h"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace tactus::cluster {

std::filesystem::path programs() { return TACTUS_PROGRAMS; }
std::filesystem::path repository() { return TACTUS_SOURCE_DIR; }
std::string tapping_scene() { return repository() / "tests/cluster/scenes/tapping.sdf"; }

Folder::Folder() {
  std::string name = std::filesystem::temp_directory_path() / "tactus-test-XXXXXX";
  if (!mkdtemp(name.data())) throw std::runtime_error("cannot make a folder like " + name);
  path_ = name;
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Processes::Processes(std::filesystem::path out, std::int64_t run_id) : out_(std::move(out)), run_id_(run_id) {
  std::filesystem::create_directories(out_ / "logs");
}

Processes::~Processes() {
  for (const auto& [name, pid] : pids_) {
    if (ended_.contains(name)) continue;
    ::kill(pid, SIGKILL);
    waitpid(pid, nullptr, 0);
  }
}

void Processes::start(const std::string& node, const std::vector<std::string>& options) {
  std::vector<std::string> command{programs() / node, "--run-id", std::to_string(run_id_), "--out", out_};
  // Tests do not open the sound card.
  if (node == "audio_node") command.insert(command.end(), {"--audio-device", "virtual"});
  // Small pictures leave the processors to the other nodes, and to the tests beside this one.
  if (node == "visual_node") command.insert(command.end(), {"--set", "width=320", "--set", "height=240"});
  command.insert(command.end(), options.begin(), options.end());
  spawn(node, command);
}

void Processes::start_all(const std::string& scene) {
  start("sync_node");
  for (const std::string& node : kModalityNodes) start(node);
  start("sim_node", {scene});
}

void Processes::spawn(const std::string& name, const std::vector<std::string>& command) {
  const std::string log = out_ / "logs" / (name + ".log");
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const pid_t pid = fork();
  if (pid < 0) throw std::runtime_error("cannot start " + name);
  if (pid == 0) {
    const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) ::signal(number, SIG_DFL);  // the caller of the test may ignore them
    execvp(words[0], words.data());
    _exit(127);
  }
  pids_[name] = pid;
  ended_.erase(name);
}

void Processes::signal(const std::string& name, int number) { ::kill(pids_.at(name), number); }

void Processes::kill(const std::string& name) {
  signal(name, SIGKILL);
  wait_for_exit(name, 10);
}

bool Processes::running(const std::string& name) { return wait_for_exit(name, 0) == -2; }

int Processes::wait_for_exit(const std::string& name, double timeout_s) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  while (!ended_.contains(name)) {
    int status = 0;
    if (waitpid(pids_.at(name), &status, WNOHANG) > 0)
      ended_[name] = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    else if (std::chrono::steady_clock::now() >= end)
      return -2;
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return ended_.at(name);
}

std::string Processes::output(const std::string& name) const {
  std::ifstream file(out_ / "logs" / (name + ".log"));
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace tactus::cluster
