// The tool of a picture is that of the instant that the picture presents.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <tactus/scene_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>

#include "tests/visual_node/support/test_scene.h"
#include "visual_node/frame/frame_composer.h"

using namespace tactus;
using namespace tactus::visual;
using std::chrono::milliseconds;

namespace {

constexpr std::int64_t kToolRun = 3, kToolBegan_ns = 10'000'000'000;
constexpr double kToolSpeed_m_s = 0.5;

double tool_x_m(double sim_s) { return 1 + kToolSpeed_m_s * sim_s; }

// A hand that moves along x, and a body that moves beside it: both are at tool_x_m() of the simulated time.
struct MovingHand {
  FrameComposer composer{kToolRun, Settings{}};
  std::int64_t sim_ns = 0;

  MovingHand() {
    scene_t scene = test::empty_scene();
    test::add_visual(scene, test::add_body(scene, {1, 0, 0}), shape_def_t::SPHERE, {0.1, 0, 0});
    test::add_tool(scene, 0.005);
    composer.load(scene, {}, Settings{});
  }
  template <class Message>
  Message message() const {
    Message m{};
    m.header.sim_time_ns = sim_ns;
    m.header.publish_time_ns = sim_ns + kToolBegan_ns;
    m.header.run_id = kToolRun;
    m.header.incarnation = 9;
    return m;
  }
  sync::HostTime now() const { return sync::host_time(sim_ns + kToolBegan_ns); }
  void run(milliseconds duration) {
    for (const std::int64_t end = sim_ns + sync::Nanoseconds(duration).count(); sim_ns < end; sim_ns += 1'000'000) {
      const double x = tool_x_m(1e-9 * static_cast<double>(sim_ns));
      auto tool = message<tool_state_t>();
      tool.header.seq = sim_ns / 1'000'000;
      tool.proxy.position_m.x = tool.device.position_m.x = x;
      tool.proxy.orientation.w = tool.device.orientation.w = 1;
      tool.proxy_velocity_m_s.x = tool.device_velocity_m_s.x = static_cast<float>(kToolSpeed_m_s);
      tool.force_N.x = static_cast<float>(x);
      composer.push(tool, now());
      if (sim_ns % 16'000'000 != 0) continue;
      auto world = message<world_state_t>();
      world.clock.sim_ns = sim_ns, world.clock.host_ns = sim_ns + kToolBegan_ns, world.clock.rate = 1;
      world.pages = world.count = 1;
      body_state_t body{};
      body.position_m.x = x, body.orientation.w = 1, body.velocity_m_s.x = static_cast<float>(kToolSpeed_m_s);
      world.bodies = {body};
      composer.push(world, now());
    }
  }
  Frame frame(sync::Nanoseconds delay, sync::Nanoseconds view_delay) { return composer.frame(now(), 0, delay, now(), view_delay); }
};

}  // namespace

TEST_CASE("Under a profile with delay a picture shows hand, force and world of one instant") {
  MovingHand hand;
  hand.run(milliseconds(1500));
  std::mt19937 random(11);
  for (int i = 0; i < 40; ++i) {
    hand.run(milliseconds(16));
    const milliseconds delay(20 + static_cast<int>(random() % 600));
    const Frame f = hand.frame(delay, delay);
    REQUIRE(f.tools.at(0).known);
    const double body_m = f.list.instances.at(0).position.x();
    // A report each millisecond, and its velocity until the instant of the picture.
    CHECK(f.tools[0].proxy.translation().x() == Approx(body_m).margin(1e-3 * kToolSpeed_m_s));
    CHECK(f.tools[0].device.translation().x() == Approx(body_m).margin(1e-3 * kToolSpeed_m_s));
    CHECK(f.tool_forces_N.at(0).x() == Approx(body_m).margin(2e-3 * kToolSpeed_m_s));
    REQUIRE(f.samples.size() == 1);
    CHECK(std::abs(static_cast<double>(f.samples[0].seq) - 1e3 * (body_m - 1) / kToolSpeed_m_s) <= 2);
  }
}

TEST_CASE("A playout delay does not delay the drawn hand") {
  MovingHand hand;
  hand.run(milliseconds(500));
  const Frame f = hand.frame(milliseconds(80), {});
  CHECK(f.tools.at(0).proxy.translation().x() == Approx(tool_x_m(0.499)).margin(1e-6));
}

TEST_CASE("The pictures of all walls of a room delay the hand with the world") {
  MovingHand hand;
  hand.run(milliseconds(1500));
  LockedFrame locked;
  locked.due_host_time = hand.now() + milliseconds(5);
  locked.delay = milliseconds(300);
  locked.sim_time = sync::sim_time(hand.sim_ns) + milliseconds(5) - locked.delay;
  const Frame f = hand.composer.frame(hand.now(), locked, hand.now(), milliseconds(300));
  CHECK(f.tools.at(0).proxy.translation().x() == Approx(tool_x_m(1.205)).margin(1e-3 * kToolSpeed_m_s));
}

TEST_CASE("Before the first report that a late picture shows, the hand is where the simulation holds it") {
  MovingHand hand;
  hand.run(milliseconds(200));
  CHECK_FALSE(hand.frame(milliseconds(400), milliseconds(400)).tools.at(0).known);
  CHECK(hand.frame(milliseconds(100), milliseconds(100)).tools.at(0).known);
}

TEST_CASE("A hand that is lost disappears from a late picture later by the delay") {
  MovingHand hand;
  hand.run(milliseconds(1000));
  hand.sim_ns += 250'000'000;  // haptic_node has ended
  CHECK_FALSE(hand.frame({}, {}).tools.at(0).known);
  CHECK(hand.frame(milliseconds(300), milliseconds(300)).tools.at(0).known);
}

TEST_CASE("Reports of tools that the scene does not have take no memory and are not shown") {
  MovingHand hand;
  hand.run(milliseconds(300));
  auto other = hand.message<tool_state_t>();
  other.proxy.orientation.w = other.device.orientation.w = 1;
  for (int tool = 1; tool < 100'000; ++tool) {
    other.tool = tool;
    hand.composer.push(other, hand.now());
  }
  const Frame f = hand.frame({}, {});
  CHECK(f.tools.size() == 1);
  CHECK(f.samples.size() == 1);
}

TEST_CASE("Before a scene the reports of a limited number of tools are stored") {
  FrameComposer composer{kToolRun, Settings{}};
  tool_state_t report{};
  report.proxy.orientation.w = report.device.orientation.w = 1;
  for (int tool = 0; tool < 10'000; ++tool) {
    report.tool = tool;
    composer.push(report, sync::host_time(kToolBegan_ns));
  }
  CHECK(composer.frame(sync::host_time(kToolBegan_ns), 0).samples.size() == 64);
}

TEST_CASE("The history of a tool stays limited, and a log that starts again replaces it") {
  ToolHistory history;
  tool_state_t state{};
  history.extend_history(milliseconds(500));
  for (int i = 0; i < 20'000; ++i) {
    state.header.seq = i;
    history.push(state, sync::host_time(250'000LL * i));
  }
  REQUIRE(history.newest());
  CHECK(history.newest()->state.header.seq == 19'999);
  CHECK_FALSE(history.arrived_by(sync::host_time(250'000LL * 13'000)));  // more than 1.5 s ago
  const auto* report = history.arrived_by(sync::host_time(250'000LL * 15'001));
  REQUIRE(report);
  CHECK(std::abs(static_cast<double>(report->state.header.seq) - 15'001) <= 4);
  state.header.seq = 7;
  history.push(state, sync::host_time(1));
  CHECK(history.newest()->state.header.seq == 7);
  CHECK_FALSE(history.arrived_by(sync::host_time(0)));
}
