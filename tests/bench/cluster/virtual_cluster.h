// A whole cluster in virtual time, with an external device and an external thermal display, for tests of failures and of
// hostile messages. Every program is the live one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "sync/virtual_time/virtual_time.h"
#include "tests/bench/cluster/arm_driver.h"

namespace tactus::bench {

class VirtualCluster {
 public:
  static constexpr std::int64_t kRun = 4711;
  // Names of its programs.
  static constexpr const char* kPrograms[] = {"sim_node",       "haptic_node", "arm_driver",  "audio_node",
                                              "thermal_node", "thermal_device", "visual_node", "sync_node"};

  // Starts the programs and runs until the hand has felt a force for two seconds. Their messages for the user go to
  // out/programs.log. on_tick: each tick of the driver of the device; listener: each message, when it is sent. Throws
  // std::runtime_error with one sentence when the cluster does not come up.
  VirtualCluster(const std::filesystem::path& out, std::uint64_t seed, std::function<void(const ArmTick&)> on_tick,
                 sync::VirtualWire::Listener listener);
  // Stops the programs, so that their files are complete.
  ~VirtualCluster();
  VirtualCluster(const VirtualCluster&) = delete;
  VirtualCluster& operator=(const VirtualCluster&) = delete;

  sync::VirtualTime& time() { return time_; }
  // Force on the hand in the newest tick of the driver, N.
  double force_N() const { return force_N_; }

 private:
  void add(const std::string& name, std::function<int(int, char**)> run, std::vector<std::string> options);

  std::filesystem::path out_;
  std::ofstream log_;
  std::streambuf* terminal_;  // of std::cerr
  sync::VirtualTime time_;
  double force_N_ = 0;
};

}  // namespace tactus::bench
