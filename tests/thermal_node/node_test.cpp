// Tests of the whole program in virtual time, with a finger that rests on hot copper: two nodes, a restarted node,
// displays of other programs.
#include <stdlib.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/thermal_device_t.hpp>
#include <tactus/thermal_state_t.hpp>
#include <vector>

#include "sync/assets/scene_sender.h"
#include "sync/bus/decode.h"
#include "sync/node/node.h"
#include "sync/virtual_time/virtual_time.h"
#include "tests/thermal_node/support/limits_trial.h"
#include "thermal_node/devices/display_program.h"
#include "thermal_node/run.h"

using namespace tactus;
using namespace std::chrono_literals;
using Catch::Contains;

namespace {

constexpr std::int64_t kRun = 4711;

scene_t hot_copper() {
  scene_t s{};
  s.step_ns = 1'000'000;
  s.bodies.resize(2), s.body_count = 2;
  s.bodies[1].id = 1;
  for (body_def_t& b : s.bodies) b.pose.orientation.w = 1;
  s.listener.orientation.w = s.camera.orientation.w = 1;
  s.tools.resize(1), s.tool_count = 1;
  s.tools[0].name = "finger", s.tools[0].body = 1, s.tools[0].radius_m = 0.01, s.tools[0].mass_kg = 0.05;
  s.materials = {thermal::material(401, 8960, 385, 200)}, s.material_count = 1;
  s.materials[0].name = "copper";
  return s;
}

// The simulation: the finger presses with 5 N from the beginning.
int simulate() {
  sync::NodeOptions options;
  options.name = "sim_node", options.run_id = kRun, options.realtime = "off";
  sync::Node node({.name = "sim_node", .modality = "", .rate_Hz = 100, .about = ""}, options);
  sync::SceneSender scene(node.bus(), {{asset_ref_t::SCENE, "scene", sync::encode(hot_copper())}});
  const sync::HostTime begin = sync::host_now();
  while (node.running()) {
    const sync::HostTime now = node.wait();
    scene.poll(now);
    contact_frame_t m{};
    m.header.sim_time_ns = (now - begin).count();
    m.clock = {m.header.sim_time_ns, sync::to_ns(now), 1};
    m.group = contact_frame_t::TOOL, m.pages = 1;
    contact_t c{};
    c.contact_id = 5, c.body_b = 1, c.material_b = -1, c.normal_force_N = 5, c.area_m2 = 1e-4f;
    c.normal.z = 1;
    c.points.resize(1), c.point_count = 1;
    m.contacts = {c}, m.count = 1;
    contact_events_t events{};
    events.header.sim_time_ns = m.header.sim_time_ns, events.clock = m.clock, events.pages = 1;
    node.bus().publish(channels::kContactEvents, events);
    node.bus().publish(channels::kContacts, m);
  }
  return 0;
}

// Programs in virtual time, and their newest messages by the name of the program.
class Cluster {
 public:
  Cluster() {
    char name[] = "/tmp/tactus_node_XXXXXX";
    folder_ = mkdtemp(name);
    time_.wire().add_listener([this](sync::HostTime now, std::string_view channel,
                                     std::span<const std::uint8_t> data) { on_message(now, channel, data); });
    time_.add("sim_node", simulate);
  }
  ~Cluster() {
    time_.end();
    std::filesystem::remove_all(folder_);
  }

  using Program = int (*)(int, char**);
  void start(const std::string& name, Program program, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{name,         "--name", name,    "--run-id", std::to_string(kRun),
                                   "--realtime", "off",    "--out", folder_};
    words.insert(words.end(), more.begin(), more.end());
    time_.add(name, [words, program]() mutable {
      std::vector<char*> argv;
      for (std::string& word : words) argv.push_back(word.data());
      return program(static_cast<int>(argv.size()), argv.data());
    });
  }
  void stop(const std::string& name) {
    time_.request_stop(name);
    time_.run_for(100ms);
  }
  void block(const char* channel, double seconds) { time_.wire().block(channel, time_.now() + sync::from_seconds(seconds)); }
  void run(double seconds) { time_.run_for(sync::from_seconds(seconds)); }

  double command_degC(const std::string& name) { return commands_[sync::fnv1a_32(name)]; }
  std::string text(const std::string& name) { return texts_[name]; }
  double plate_degC() const { return plate_degC_; }
  double warm_s() const { return warm_s_; }
  const std::string& folder() const { return folder_; }

 private:
  void on_message(sync::HostTime, std::string_view channel, std::span<const std::uint8_t> data) {
    if (channel == channels::kThermalState) {
      const auto m = sync::decode<thermal_state_t>(data.data(), data.size());
      REQUIRE(m);
      commands_[static_cast<std::uint32_t>(m->header.source)] = m->commanded_degC;
      if (m->commanded_degC > 39) warm_s_ += 0.02;
    } else if (channel == channels::kThermalDevice) {
      plate_degC_ = sync::decode<thermal_device_t>(data.data(), data.size()).value().plate_degC;
    } else if (channel == channels::kNodeHealth) {
      const auto m = sync::decode<node_health_t>(data.data(), data.size());
      REQUIRE(m);
      texts_[m->node] = m->status_text;
    }
  }

  sync::VirtualTime time_;
  std::string folder_;
  std::map<std::uint32_t, double> commands_;
  std::map<std::string, std::string> texts_;
  double plate_degC_ = 0, warm_s_ = 0;
};

}  // namespace

TEST_CASE("Two nodes of one tool command the plate to rest, and the remaining one resumes") {
  Cluster c;
  c.start("thermal_node", thermal::run);
  c.run(4);
  CHECK(c.command_degC("thermal_node") > 36);
  c.start("second", thermal::run);
  c.run(3);
  for (const char* name : {"thermal_node", "second"}) {
    INFO(name);
    CHECK(c.command_degC(name) == 33);
    CHECK_THAT(c.text(name), Contains("two programs send THERMAL_STATE"));
  }
  c.stop("thermal_node");
  c.run(3);
  CHECK(c.command_degC("second") > 36);
  CHECK_THAT(c.text("second"), !Contains("two programs"));
}

TEST_CASE("Lost contact snapshots return the plate to neutral, also while contact events arrive") {
  Cluster c;
  c.start("thermal_node", thermal::run);
  c.run(4);
  REQUIRE(c.command_degC("thermal_node") > 36);
  c.block(channels::kContacts, 2);
  c.run(1.5);
  CHECK(c.command_degC("thermal_node") == Approx(33).margin(0.1));
  CHECK_THAT(c.text("thermal_node"), Contains("no contacts"));
  c.run(3);
  CHECK(c.command_degC("thermal_node") > 36);
}

TEST_CASE("A restarted node continues with the exposure of its predecessor") {
  Cluster c;
  const std::vector<std::string> stored{"--exposure", c.folder() + "/exposure"};
  c.start("thermal_node", thermal::run, stored);
  c.run(150);
  CHECK(c.warm_s() > 120);
  c.stop("thermal_node");
  c.start("thermal_node", thermal::run, stored);
  c.run(200);
  CHECK(c.warm_s() <= 240);
  CHECK(c.warm_s() > 200);
}

TEST_CASE("A display of another program is used when it answers, and not when two answer") {
  Cluster c;
  c.start("thermal_node", thermal::run, {"--set", "device=external"});
  c.run(3);
  CHECK(c.command_degC("thermal_node") == 33);
  CHECK_THAT(c.text("thermal_node"), Contains("no display answers"));
  c.start("thermal_device", thermal::run_display);
  c.run(4);
  CHECK(c.command_degC("thermal_node") > 36);
  CHECK(c.plate_degC() == Approx(c.command_degC("thermal_node")).margin(0.5));
  c.start("second_display", thermal::run_display);
  c.run(3);
  CHECK(c.command_degC("thermal_node") == 33);
  CHECK_THAT(c.text("thermal_node"), Contains("two programs send THERMAL_DEVICE"));
  c.stop("thermal_device");
  c.run(4);
  CHECK(c.command_degC("thermal_node") > 36);
  CHECK_THAT(c.text("thermal_node"), !Contains("two programs"));
}

TEST_CASE("A display of another program beside the simulated one is a conflict") {
  Cluster c;
  c.start("thermal_node", thermal::run);
  c.start("thermal_device", thermal::run_display);
  c.run(4);
  CHECK(c.command_degC("thermal_node") == 33);
  CHECK_THAT(c.text("thermal_node"), Contains("another program sends THERMAL_DEVICE"));
}

TEST_CASE("A display returns its plate to neutral when two nodes command it, and when none does") {
  Cluster c;
  c.start("thermal_node", thermal::run, {"--set", "device=external"});
  c.start("thermal_device", thermal::run_display);
  c.run(4);
  REQUIRE(c.plate_degC() > 36);
  SECTION("none") { c.stop("thermal_node"); }
  SECTION("two") { c.start("second", thermal::run, {"--set", "device=external"}); }
  c.run(2);
  CHECK(c.plate_degC() == Approx(33).margin(0.2));
  CHECK_THAT(c.text("thermal_device"), Contains("the plate is neutral"));
}
