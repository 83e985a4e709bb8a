// Access of a cluster test to the picture: the newest frame of visual_node as grey values, and its replies to changes of settings.
#pragma once

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "tests/cluster/support/running.h"

namespace tactus::cluster {

using Grey = std::vector<unsigned char>;

// Mean difference of two pictures, of 255.
inline double mean_difference(const Grey& a, const Grey& b) {
  REQUIRE(a.size() == b.size());
  REQUIRE(!a.empty());
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum / static_cast<double>(a.size());
}

struct PictureCluster : RunningCluster {
  std::filesystem::path snapshot = folder.path() / "now.png";
  int call_count = 0;

  // Options of visual_node: pictures of 640 x 480, ten per second.
  std::vector<std::string> snapshots() const {
    return {"--no-video", "--snapshot", snapshot, "--snapshot-every", "0.1"};
  }
  // Starts a cluster whose visual_node has these options; the given words precede its command.
  void start_with(const std::vector<std::string>& options, const std::vector<std::string>& before = {}) {
    processes.start("sync_node");
    for (const char* node : {"haptic_node", "audio_node", "thermal_node"}) processes.start(node);
    start_vision(options, before);
    processes.start("sim_node", {tapping_scene()});
    const bool running = monitor.wait_until([&] { return all_running(kNodes) && monitor.hits() > 0; }, kTimeout_s);
    UNSCOPED_INFO(log_text());
    REQUIRE(running);
  }
  void start_vision(const std::vector<std::string>& options, const std::vector<std::string>& before = {}) {
    std::vector<std::string> command{"env"};
    command.insert(command.end(), before.begin(), before.end());
    command.insert(command.end(),
                   {programs() / "visual_node", "--run-id", std::to_string(kRunId), "--out", folder.path()});
    command.insert(command.end(), options.begin(), options.end());
    processes.spawn("visual_node", command);
  }
  // Decodes a picture with ffmpeg.
  Grey grey(const std::string& input) {
    const auto raw = folder.path() / "now.raw";
    const std::string command =
        "ffmpeg -v error -y " + input + " -frames:v 1 -f rawvideo -pix_fmt gray " + quoted(raw);
    REQUIRE(std::system(command.c_str()) == 0);
    std::ifstream file(raw, std::ios::binary);
    return Grey(std::istreambuf_iterator<char>(file), {});
  }
  Grey picture() { return grey("-i " + quoted(snapshot)); }
  // A picture that is drawn a few frames from now.
  Grey later_picture() {
    const std::int64_t before = monitor.ticks("visual_node");
    CHECK(monitor.wait_until([&] { return monitor.ticks("visual_node") > before + 12; }, kTimeout_s));
    monitor.receive_for(0.5);
    return picture();
  }
  // Output of the program `set`: one line.
  std::string set(const std::vector<std::string>& words, int wanted_status = 0) {
    const std::string name = "set" + std::to_string(++call_count);
    std::vector<std::string> command{programs() / "set", "--run-id", std::to_string(kRunId), "visual_node"};
    command.insert(command.end(), words.begin(), words.end());
    processes.spawn(name, command);
    const int status = processes.wait_for_exit(name, kTimeout_s);
    const std::string output = processes.output(name);
    INFO(output);
    CHECK(status == wanted_status);
    CHECK(std::count(output.begin(), output.end(), '\n') == 1);
    return output;
  }
  bool keeps_ticking(const std::string& node) {
    const std::int64_t before = monitor.ticks(node);
    return monitor.wait_until([&] { return is_running(node) && monitor.ticks(node) > before + 5; }, kTimeout_s);
  }
  // The modalities without vision: touch, sound and warmth are live, and hits are published.
  bool others_running() {
    const std::int64_t hits = monitor.hits();
    return monitor.wait_until(
        [&] {
          return monitor.hits() > hits && all_running({"sim_node", "haptic_node", "audio_node", "thermal_node"});
        },
        kTimeout_s);
  }
};

}  // namespace tactus::cluster
