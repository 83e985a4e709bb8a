// Tests of a head pose from an external program: it moves the camera and nothing else.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <tactus/device_state_t.hpp>
#include <tactus/node_health_t.hpp>

#include "lcmtypes/vectors.h"
#include "sync/bus/bus.h"
#include "tests/cluster/support/running.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

using Pixels = std::vector<unsigned char>;

// Mean difference of two pictures, of 255.
double mean_colour_difference(const Pixels& a, const Pixels& b) {
  REQUIRE(a.size() == b.size());
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum / static_cast<double>(a.size());
}

struct ClusterWithHead : RunningCluster {
  std::filesystem::path snapshot = folder.path() / "now.png";
  bool head_ran = false;  // its node was RUNNING
  int buttons = 0;       // of the head, as in any TOOL_STATE: beside heavy load a device is lost for moments
  sync::Bus tracker{sync::Identity::fresh("tracker", kRunId), {}};

  void start_all() {
    const std::string scene = repository() / "tests/cluster/scenes/head.sdf";
    processes.start("sync_node");
    for (const char* node : {"haptic_node", "audio_node", "thermal_node"}) processes.start(node);
    start_head();
    processes.start("visual_node", {"--no-video", "--snapshot", snapshot, "--snapshot-every", "0.1"});
    processes.start("sim_node", {scene});
    const bool alive = monitor.wait_until([&] { return all_running(kNodes) && monitor.hits() > 0; }, kTimeout_s);
    UNSCOPED_INFO(log_text());
    REQUIRE(alive);
  }
  void start_head(const std::string& tool = "head") {
    processes.spawn("haptic_node_" + tool,
                    {programs() / "haptic_node", "--run-id", std::to_string(kRunId), "--out", folder.path(),
                     "--name", "haptic_node_" + tool, "--tool", tool});
  }
  // Sends the head pose at 250 Hz for the given time. Yaw about z.
  void publish_pose(const Eigen::Vector3d& moved_m, double yaw_rad, double seconds, const char* device = "head") {
    const sync::HostTime end = sync::host_now() + sync::from_seconds(seconds);
    while (sync::host_now() < end) {
      device_state_t m{};
      m.header.sim_time_ns = -1;
      m.device = device;
      m.pose.position_m = to_vec3(moved_m);
      m.pose.orientation = to_quat(Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())));
      m.buttons = 5;
      m.state = device_state_t::ANSWERS;
      tracker.publish(channels::kDeviceState, m);
      monitor.receive_for(0.004);
      if (monitor.tool_state() && monitor.tool_state()->tool == 1) buttons |= monitor.tool_state()->buttons;
      head_ran = head_ran || is_running("haptic_node_head");
    }
  }
  // The picture after 1 s at this pose. Frames are rare beside heavy load, and a snapshot is one of them.
  Pixels picture_at(const Eigen::Vector3d& moved_m, double yaw_rad, const char* device = "head") {
    const std::int64_t before = monitor.ticks("visual_node");
    for (double held = 0; held < 1.5 || (monitor.ticks("visual_node") < before + 12 && held < kTimeout_s);
         held += 0.5)
      publish_pose(moved_m, yaw_rad, 0.5, device);
    return picture();
  }
  Pixels picture() {
    const auto raw = folder.path() / "now.raw";
    const std::string command =
        "ffmpeg -v error -y -i " + quoted(snapshot) + " -f rawvideo -pix_fmt gray " + quoted(raw);
    REQUIRE(std::system(command.c_str()) == 0);
    std::ifstream file(raw, std::ios::binary);
    return Pixels(std::istreambuf_iterator<char>(file), {});
  }
  std::string note(const std::string& node) const { return monitor.health(node) ? monitor.health(node)->status_text : "silent"; }
};

}  // namespace

TEST_CASE("A head that a program moves changes the picture and nothing else, and the view stays after its loss") {
  ClusterWithHead c;
  c.start_all();
  const Pixels at_rest = c.picture_at({0, 0, 0}, 0);
  REQUIRE(at_rest.size() == 320 * 240);
  CHECK(*std::max_element(at_rest.begin(), at_rest.end()) > 40);  // the picture is lit
  CHECK(mean_colour_difference(at_rest, c.picture_at({0, 0, 0}, 0)) < 0.5);
  CHECK(c.head_ran);
  CHECK(c.buttons == 5);
  const auto before = c.rates(1);

  const Pixels turned = c.picture_at({0, 0, 0}, 0.2), aside = c.picture_at({0, -0.15, 0}, 0);
  CHECK(mean_colour_difference(at_rest, turned) > 3);
  CHECK(mean_colour_difference(at_rest, aside) > 3);
  CHECK(mean_colour_difference(turned, aside) > 3);
  CHECK(mean_colour_difference(at_rest, c.picture_at({0, 0, 0}, 0)) < 0.5);  // and back at rest
  c.check_rates_hold(before, 2);

  // The device sends no more: the view stays, touch by the other hand continues.
  c.picture_at({0, -0.15, 0}, 0);
  CHECK(c.monitor.wait_until([&] { return c.state("haptic_node_head", node_health_t::OUTPUT_LOST); }, kTimeout_s));
  c.monitor.receive_for(0.5);
  CHECK(mean_colour_difference(c.picture(), aside) < 0.5);
  // Its node is killed.
  c.processes.kill("haptic_node_head");
  const bool reported = c.monitor.wait_until(
      [&] { return c.note("visual_node").find("the head is lost: the view stays") != std::string::npos; },
      kTimeout_s);
  INFO(c.note("visual_node"));
  CHECK(reported);
  CHECK(mean_colour_difference(c.picture(), aside) < 0.5);
  CHECK(c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s));
  const std::int64_t hits = c.monitor.hits();
  CHECK(c.monitor.wait_until([&] { return c.monitor.hits() > hits; }, kTimeout_s));

  c.start_head();
  CHECK(c.monitor.wait_until([&] { return c.monitor.health("haptic_node_head") != nullptr; }, kTimeout_s));
  CHECK(mean_colour_difference(at_rest, c.picture_at({0, 0, 0}, 0)) < 0.5);
  CHECK(c.note("visual_node").find("head") == std::string::npos);
}

TEST_CASE("A wand that a program moves directs the light to its position, and the light stays there after its loss") {
  ClusterWithHead c;
  c.start_all();
  c.start_head("wand");
  const Pixels middle = c.picture_at({0, 0, 0.05}, 0, "wand");
  const Pixels left = c.picture_at({0, 0.3, 0}, 0, "wand"), right = c.picture_at({0, -0.3, 0}, 0, "wand");
  CHECK(mean_colour_difference(middle, left) > 1);
  CHECK(mean_colour_difference(left, right) > 1);
  // The lit half is the one that the head points to: the left of the picture is the left of the camera.
  const auto half = [](const Pixels& p, bool left_half) {
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i)
      if ((i % 320 < 160) == left_half) sum += p[i];
    return sum;
  };
  CHECK(half(left, true) > half(right, true));
  CHECK(half(right, false) > half(left, false));
  CHECK(c.monitor.wait_until([&] { return c.state("haptic_node_wand", node_health_t::OUTPUT_LOST); }, kTimeout_s));
  c.monitor.receive_for(0.5);
  CHECK(mean_colour_difference(c.picture(), right) < 0.5);
  CHECK(c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s));
}
