// Starts, stops, freezes and kills real processes of the cluster. All processes end with the test.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tactus::cluster {

inline const std::vector<std::string> kModalityNodes{"haptic_node", "audio_node", "visual_node", "thermal_node"};
inline const std::vector<std::string> kNodes{"sim_node", "haptic_node", "audio_node", "visual_node", "thermal_node"};

// The small scene of these tests: balls that drop, and a tool that taps without end.
std::string tapping_scene();

// A temporary folder that is removed with its object.
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
  // Nodes write into `out`; their output goes to out/logs/NAME.log.
  Processes(std::filesystem::path out, std::int64_t run_id);
  ~Processes();
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;

  // Starts one of our nodes with the common options and the given ones.
  void start(const std::string& node, const std::vector<std::string>& options = {});
  // Starts sim_node with a scene, all modalities, and sync_node.
  void start_all(const std::string& scene);
  // Starts any program.
  void spawn(const std::string& name, const std::vector<std::string>& command);

  void signal(const std::string& name, int number);
  // Sends SIGKILL and waits until the process has ended.
  void kill(const std::string& name);
  // True while the process has not ended.
  bool running(const std::string& name);
  // Waits up to timeout_s seconds. Returns the exit status; -1 when a signal killed the process, -2 when it still runs.
  int wait_for_exit(const std::string& name, double timeout_s);
  // The output of a process so far.
  std::string output(const std::string& name) const;

 private:
  std::filesystem::path out_;
  std::int64_t run_id_;
  std::map<std::string, pid_t> pids_;
  std::map<std::string, int> ended_;
};

// Quotes for a shell: a folder may have a blank in its name.
inline std::string quoted(const std::string& word) { return "'" + word + "'"; }

// The folder of the programs under test.
std::filesystem::path programs();
// The root of the repository.
std::filesystem::path repository();

}  // namespace tactus::cluster
