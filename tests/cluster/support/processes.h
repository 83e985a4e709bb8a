// Real processes of the cluster, started, stopped, frozen and killed by a test. All end with the test.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tactus::cluster {

inline const std::vector<std::string> kSenses{"haptic_node", "audio_node", "visual_node", "thermal_node"};
inline const std::vector<std::string> kNodes{"sim_node", "haptic_node", "audio_node", "visual_node", "thermal_node"};

// The small scene of these tests: balls that drop and a tool that taps for ever.
std::string tapping_scene();

// A folder that vanishes with it.
class Folder {
 public:
  Folder();
  ~Folder();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

class Processes {
 public:
  // Nodes write into `out`; what they say goes to out/logs/NAME.log.
  Processes(std::filesystem::path out, std::int64_t run_id);
  ~Processes();
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;

  // Starts one of our nodes with the options that all have and some of its own.
  void start(const std::string& node, const std::vector<std::string>& options = {});
  // sim_node with a scene, all senses, sync_node.
  void start_all(const std::string& scene);
  // Starts any program.
  void spawn(const std::string& name, const std::vector<std::string>& command);

  void signal(const std::string& name, int number);
  // SIGKILL, and waits until it is gone.
  void kill(const std::string& name);
  // True while the process has not ended.
  bool running(const std::string& name);
  // Exit status once it has ended within so many seconds; -1 when it was killed by a signal, -2 when it has not ended.
  int wait_for_exit(const std::string& name, double at_most_s);
  // What it has said.
  std::string said(const std::string& name) const;

 private:
  std::filesystem::path out_;
  std::int64_t run_id_;
  std::map<std::string, pid_t> pids_;
  std::map<std::string, int> ended_;
};

// For a shell: a folder may have a blank in its name.
inline std::string quoted(const std::string& word) { return "'" + word + "'"; }

// The folder of the programs under test.
std::filesystem::path programs();
// The root of the repository.
std::filesystem::path repository();

}  // namespace tactus::cluster
