#include "sim_node/command/commander.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <limits>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <tactus/touch_plane_t.hpp>
#include <thread>

#include "lcmtypes/vectors.h"
#include "tests/sim_node/support/simple_hand.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

WorldDef table() {
  WorldDef w = empty_world();
  add_floor(w);
  add_ball(w, 0.2, 0.05, {0, 0, 0.05});
  const int rotor = add_box(w, 0.1, {0.3, 0.02, 0.05}, at(1, 0, 0.2));
  w.bodies.back().name = "fan::rotor";
  add_joint(w, JointKind::kRevolute, -1, rotor, {1, 0, 0.2}, {0, 0, 1}).name = "fan::axle";
  add_tool(w, {0, 0, 0.5});
  return w;
}

sim_command_t command(int kind, const std::string& name = "", const std::string& property = "",
                      std::vector<double> values = {}) {
  static std::int64_t id = 0;
  sim_command_t c{};
  c.id = ++id;
  c.kind = static_cast<std::int8_t>(kind);
  c.name = name;
  c.property = property;
  c.values = std::move(values);
  c.count = static_cast<std::int8_t>(c.values.size());
  return c;
}

sim_command_t push(const std::string& body, const Vector3d& force, double seconds) {
  sim_command_t c = command(sim_command_t::PUSH, body);
  c.force_N = to_vec3(force);
  c.duration_ns = sync::from_seconds(seconds).count();
  return c;
}

struct Bench {
  WorldDef world = table();
  Simulation simulation{world, {}};
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("tactus_commands_" + std::to_string(getpid()));
  Commander commander{simulation, world, folder};

  Bench() {
    std::filesystem::create_directories(folder);
    simulation.start(11);
  }
  ~Bench() { std::filesystem::remove_all(folder); }

  // As in sim_node.
  void tick() {
    if (commander.step_due())
      simulation.step({});
    else
      simulation.hold({});
  }
  // The reply to a command. Waits for file operations.
  sim_reply_t request(const sim_command_t& c) {
    commander.execute(c);
    for (const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
         std::chrono::steady_clock::now() < end;) {
      for (const sim_reply_t& r : commander.take_replies())
        if (r.id == c.id) return r;
      std::this_thread::yield();
    }
    FAIL("no answer");
    return {};
  }
  std::string command_error(const sim_command_t& c) {
    const auto before = simulation.save();
    const sim_reply_t r = request(c);
    CHECK(r.done == 0);
    CHECK(simulation.save() == before);
    return r.text;
  }
  const BodyMotion& ball() { return simulation.bodies()[1]; }
};

}  // namespace

TEST_CASE("Commands pause, step and resume a world") {
  Bench b;
  for (int i = 0; i < 10; ++i) b.tick();
  CHECK(b.request(command(sim_command_t::PAUSE)).paused == 1);
  for (int i = 0; i < 50; ++i) b.tick();
  CHECK(b.simulation.now() == sync::sim_time(10'000'000));
  sim_command_t step = command(sim_command_t::STEP);
  step.steps = 3;
  CHECK(b.request(step).done == 1);
  for (int i = 0; i < 50; ++i) b.tick();
  CHECK(b.simulation.now() == sync::sim_time(13'000'000));
  CHECK(b.request(command(sim_command_t::RESUME)).paused == 0);
  for (int i = 0; i < 7; ++i) b.tick();
  CHECK(b.simulation.now() == sync::sim_time(20'000'000));
  CHECK_THAT(b.command_error(step = command(sim_command_t::STEP)), Catch::Contains("pause it"));
}

TEST_CASE("A pause changes only the host time of the following steps") {
  Bench paused, straight;
  const sim_command_t spin = command(sim_command_t::SET, "ball", "velocity", {0.5, 0.2, 0});
  paused.request(spin), straight.request(spin);
  for (int i = 0; i < 300; ++i) {
    if (i == 100) paused.request(command(sim_command_t::PAUSE));
    if (i == 100)
      for (int k = 0; k < 40; ++k) paused.tick();
    if (i == 100) paused.request(command(sim_command_t::RESUME));
    paused.tick(), straight.tick();
    CHECK(paused.ball().position_m == straight.ball().position_m);
  }
}

TEST_CASE("A paused world has touch planes at the hand and receives no impulse from it") {
  Bench b;
  b.request(command(sim_command_t::SET, "ball", "velocity", {0, 0, 2}));
  for (int i = 0; i < 20; ++i) b.tick();
  b.request(command(sim_command_t::PAUSE));
  const Vector3d place = b.simulation.bodies()[1].position_m;
  Hand hand{.radius = 0.01, .last = {0.3, 0, 0.5}};
  bool floor = false, ball = false;
  const auto at_place = [&](const Vector3d& p) {
    for (int i = 0; i < 30; ++i) b.simulation.hold(std::vector{hand.tick(b.simulation.touch_models()[0], p, 0)});
    CHECK(b.simulation.events().size() == 0);
    for (const touch_plane_t& plane : b.simulation.touch_models()[0].planes) {
      floor = floor || plane.body == 0;
      ball = ball || plane.body == 1;
      CHECK(to_eigen(plane.velocity_m_s).norm() == 0);
    }
  };
  b.tick();
  at_place({0.3, 0, 0.005});
  CHECK((floor && !ball));
  floor = false;
  at_place(place + Vector3d(0, 0, 0.055));
  CHECK((ball && !floor));
  CHECK(b.simulation.bodies()[1].velocity_m_s.norm() == 0);
  b.request(command(sim_command_t::RESUME));
  // The push during the pause is not applied later: the ball flies on, 2 m/s less gravity.
  b.simulation.step(std::vector{hand.tick(b.simulation.touch_models()[0], {0, 0, 0.5}, 0)});
  CHECK(b.simulation.bodies()[1].velocity_m_s.z() == Approx(2 - 9.81 * 0.022).margin(0.06));
}

TEST_CASE("A repeated command takes effect once and is answered each time") {
  Bench b;
  const sim_command_t kick = push("ball", {2, 0, 0}, 0.01);
  for (int i = 0; i < 50; ++i) {
    CHECK(b.request(kick).done == 1);
    b.tick();
  }
  CHECK(b.simulation.wrenches() == 0);
  // 2 N for 10 ms on 0.2 kg, less the effect of friction.
  CHECK(b.ball().velocity_m_s.x() < 0.1);
  CHECK(b.ball().velocity_m_s.x() > 0.02);
  const sim_command_t wrong = command(sim_command_t::SET, "ball", "mass", {-1});
  CHECK(b.request(wrong).text == b.request(wrong).text);
}

TEST_CASE("A push gives a free body the commanded impulse") {
  Bench b;
  b.request(command(sim_command_t::SET, "world", "gravity", {0, 0, 0}));
  b.request(command(sim_command_t::SET, "ball", "pose", {0, 0, 1, 0, 0, 0}));
  sim_command_t kick = push("ball", {1, -2, 0.5}, 0.025);
  kick.torque_N_m = {0.001, 0, 0};
  const BodyMotion before = b.ball();
  REQUIRE(b.request(kick).done == 1);
  for (int i = 0; i < 40; ++i) b.tick();
  CHECK((b.ball().velocity_m_s - before.velocity_m_s - Vector3d(1, -2, 0.5) * 0.025 / 0.2).norm() < 1e-9);
  CHECK(b.ball().spin_rad_s.x() == Approx(0.001 * 0.025 / (0.4 * 0.2 * 0.05 * 0.05)));
}

TEST_CASE("Every property can be set") {
  Bench b;
  CHECK(b.request(command(sim_command_t::SET, "world", "gravity", {0, 0, -1.6})).done == 1);
  CHECK(b.request(command(sim_command_t::SET, "ball", "pose", {0.2, 0.1, 1, 0, 0, 0})).done == 1);
  CHECK(b.request(command(sim_command_t::SET, "ball", "velocity", {1, 0, 0})).done == 1);
  CHECK(b.request(command(sim_command_t::SET, "ball", "spin", {0, 3, 0})).done == 1);
  CHECK(b.request(command(sim_command_t::SET, "ball", "mass", {0.4})).done == 1);
  CHECK(b.request(command(sim_command_t::SET, "ball", "friction", {0.1})).done == 1);
  CHECK(b.request(command(sim_command_t::SET, "floor", "friction", {0.1})).done == 1);
  CHECK(b.request(command(sim_command_t::SET, "ball", "restitution", {1})).done == 1);
  CHECK(b.request(command(sim_command_t::SET, "floor", "restitution", {0.5})).done == 1);
  CHECK(b.request(command(sim_command_t::SET, "fan::axle", "motor", {-0.01, 50})).done == 1);
  for (int i = 0; i < 500; ++i) b.tick();
  CHECK((b.ball().position_m - Vector3d(0.7, 0.1, 1 - 0.8 * 0.25)).norm() < 2e-3);
  CHECK(b.ball().spin_rad_s.y() == Approx(3));
  CHECK(b.ball().inverse_mass_1_kg == Approx(2.5));
  CHECK(b.simulation.bodies()[2].spin_rad_s.z() < -5);
  // It bounces with half its speed: v = sqrt(2 1.6 0.95).
  double up = 0;
  for (int i = 0; i < 1000; ++i) {
    b.tick();
    up = std::max(up, b.ball().velocity_m_s.z());
  }
  CHECK(up == Approx(0.5 * std::sqrt(2 * 1.6 * 0.95)).epsilon(0.02));
  // The scene is reset.
  CHECK(b.request(command(sim_command_t::RESET)).done == 1);
  CHECK(b.commander.take_restart());
  CHECK(!b.commander.take_restart());
  CHECK(b.ball().inverse_mass_1_kg == Approx(5));
  CHECK((b.ball().position_m - Vector3d(0, 0, 0.05)).norm() < 1e-12);
}

TEST_CASE("An invalid command is rejected with a message and changes nothing") {
  Bench b;
  for (int i = 0; i < 5; ++i) b.tick();
  const auto set = [](const std::string& of, const std::string& property, std::vector<double> values) {
    return command(sim_command_t::SET, of, property, std::move(values));
  };
  CHECK_THAT(b.command_error(set("nobody", "mass", {1})), Catch::Contains("\"nobody\""));
  CHECK_THAT(b.command_error(set("ball", "colour", {1})), Catch::Contains("it has mass, pose"));
  CHECK_THAT(b.command_error(set("ball", "velocity", {1})), Catch::Contains("takes 3 numbers"));
  CHECK_THAT(b.command_error(set("ball", "mass", {0})), Catch::Contains("between"));
  CHECK_THAT(b.command_error(set("ball", "mass", {std::numeric_limits<double>::quiet_NaN()})),
             Catch::Contains("between"));
  CHECK_THAT(b.command_error(set("ball", "velocity", {0, 0, 21})), Catch::Contains("between -20 and 20"));
  CHECK_THAT(b.command_error(set("floor", "mass", {1})), Catch::Contains("fixed"));
  CHECK_THAT(b.command_error(set("hand", "pose", {0, 0, 0, 0, 0, 0})), Catch::Contains("hand"));
  CHECK_THAT(b.command_error(set("fan::rotor", "pose", {0, 0, 0, 0, 0, 0})), Catch::Contains("joint"));
  CHECK_THAT(b.command_error(set("fan::axle", "mass", {1})), Catch::Contains("motor, friction"));
  CHECK_THAT(b.command_error(push("ball", {101, 0, 0}, 0.1)), Catch::Contains("100 N"));
  CHECK_THAT(b.command_error(push("ball", {1, 0, 0}, 11)), Catch::Contains("10 s"));
  CHECK_THAT(b.command_error(push("ball", {1, 0, 0}, 0)), Catch::Contains("1 ms"));
  CHECK_THAT(b.command_error(push("floor", {1, 0, 0}, 0.1)), Catch::Contains("fixed"));
  CHECK_THAT(b.command_error(command(sim_command_t::RESTORE, "never")), Catch::Contains("no file"));
  CHECK_THAT(b.command_error(command(sim_command_t::SNAPSHOT, "../etc")), Catch::Contains("letters"));
  CHECK_THAT(b.command_error(command(sim_command_t::RESTORE, "")), Catch::Contains("letters"));
}

TEST_CASE("The number of active pushes is limited") {
  Bench b;
  for (std::size_t i = 0; i < Simulation::kMaxWrenches; ++i)
    CHECK(b.request(push("ball", {0.01, 0, 0}, 0.05)).done == 1);
  CHECK_THAT(b.command_error(push("ball", {0.01, 0, 0}, 0.05)), Catch::Contains("64 pushes are active"));
  for (int i = 0; i < 60; ++i) b.tick();
  CHECK(b.request(push("ball", {0.01, 0, 0}, 0.05)).done == 1);
}

TEST_CASE("A stored state is restored by name from memory, and by another process from its file") {
  Bench b;
  b.request(command(sim_command_t::SET, "ball", "velocity", {0.3, 0, 0}));
  for (int i = 0; i < 100; ++i) b.tick();
  sim_command_t keep = command(sim_command_t::SNAPSHOT, "rolling");
  keep.to_file = 1;
  CHECK_THAT(b.request(keep).text, Catch::Contains("rolling.state"));
  const auto state = b.simulation.save();
  for (int i = 0; i < 100; ++i) b.tick();
  CHECK(b.request(command(sim_command_t::RESTORE, "rolling")).done == 1);
  CHECK(b.commander.take_restart());
  CHECK(b.simulation.save() == state);

  Bench other;
  other.commander.execute(command(sim_command_t::PAUSE));
  CHECK(other.request(command(sim_command_t::RESTORE, "rolling")).done == 1);
  CHECK(other.simulation.save() == state);
  CHECK(other.commander.paused());

  std::ofstream(b.folder / "broken.state") << "TACTSTAT and then nothing of use";
  CHECK_THAT(b.command_error(command(sim_command_t::RESTORE, "broken")), Catch::Contains("not a saved state"));
}

TEST_CASE("The number of stored states is limited, and a repeated name replaces the old state") {
  Bench b;
  for (std::size_t i = 0; i < StateStore::kMax; ++i)
    CHECK(b.request(command(sim_command_t::SNAPSHOT, "s" + std::to_string(i))).done == 1);
  CHECK_THAT(b.command_error(command(sim_command_t::SNAPSHOT, "another")), Catch::Contains("16 states are stored"));
  CHECK(b.request(command(sim_command_t::SNAPSHOT, "s3")).done == 1);
}
