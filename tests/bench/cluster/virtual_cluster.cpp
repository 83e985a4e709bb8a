#include "tests/bench/cluster/virtual_cluster.h"

#include <iostream>
#include <stdexcept>
#include <utility>

#include "audio_node/run.h"
#include "haptic_node/run.h"
#include "sim_node/run.h"
#include "sync/tools/sync_node.h"
#include "thermal_node/devices/display_program.h"
#include "thermal_node/run.h"
#include "visual_node/run.h"

namespace tactus::bench {
namespace {

using namespace std::chrono_literals;

constexpr int kStartTimeout_s = 30;
constexpr double kFelt_N = 0.5;

}  // namespace

VirtualCluster::VirtualCluster(const std::filesystem::path& out, std::uint64_t seed, std::function<void(const ArmTick&)> on_tick,
                               sync::VirtualWire::Listener listener)
    : out_(out), log_(out / "programs.log"), terminal_(std::cerr.rdbuf(log_.rdbuf())), time_({.seed = seed}) {
  time_.wire().add_listener(std::move(listener));
  const std::string scene = std::string(TACTUS_SOURCE_DIR) + "/tests/bench/cluster/pressed.sdf";
  add("sim_node", [](int argc, char** argv) { return sim::run(argc, argv); }, {scene});
  add("haptic_node", haptic::run, {});
  time_.add("arm_driver", [this, on_tick = std::move(on_tick)] {
    return run_arm_driver(kRun, [&](const ArmTick& tick) {
      force_N_ = examples::size(tick.exerted.force);
      on_tick(tick);
    });
  });
  add("audio_node", audio::run, {});
  add("thermal_node", thermal::run, {"--set", "device=external"});
  add("thermal_device", thermal::run_display, {"--tool", "0"});
  add("visual_node", visual::run, {"--no-pictures"});
  add("sync_node", sync::run_sync_node, {});
  try {
    for (int s = 0; force_N_ < kFelt_N; ++s) {
      if (s == kStartTimeout_s) throw std::runtime_error("the hand feels nothing; see " + (out / "programs.log").string());
      for (int ms = 0; ms < 1000 && force_N_ < kFelt_N; ++ms) time_.run_for(1ms);
    }
    time_.run_for(2s);
  } catch (...) {
    std::cerr.rdbuf(terminal_);
    throw;
  }
}

VirtualCluster::~VirtualCluster() {
  time_.end();
  std::cerr.rdbuf(terminal_);
}

void VirtualCluster::add(const std::string& name, std::function<int(int, char**)> run, std::vector<std::string> options) {
  std::vector<std::string> words{name, "--run-id", std::to_string(kRun), "--out", out_, "--realtime", "off"};
  words.insert(words.end(), options.begin(), options.end());
  time_.add(name, [words, run = std::move(run)]() mutable {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    return run(static_cast<int>(words.size()), argv.data());
  });
}

}  // namespace tactus::bench
