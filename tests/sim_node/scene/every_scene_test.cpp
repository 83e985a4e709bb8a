// Every scene of the project loads without a warning, runs, is touched, and stays in one piece.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdarg>
#include <filesystem>
#include <ode/error.h>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/game_state_t.hpp>
#include <tactus/tool_def_t.hpp>

#include "lcmtypes/vectors.h"
#include "sim_node/world/engine.h"
#include "sim_node/world/simulation.h"
#include "sim_node/behaviour/single_group.h"
#include "sim_node/collision/detector.h"
#include "sim_node/scene/load_sdf.h"
#include "tests/sim_node/support/simple_hand.h"
#include "tests/sim_node/support/small_worlds.h"
#include "tests/source_dir.h"

using namespace tactus;
using namespace tactus::sim;
using Eigen::Vector3d;

namespace {

int solver_failures = 0;  // messages of ODE: its LCP solver prints one when it fails on a redundant contact

std::vector<std::filesystem::path> scenes() {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(source_dir() + "/sim_node/scenes"))
    if (entry.path().extension() == ".sdf") found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

// Position of a tool on its path at a time: straight legs, repeated. A tool without a path stays at its initial pose.
Vector3d along(const WorldDef& w, const tool_def_t& tool, double t) {
  const auto& path = tool.waypoints;
  if (path.empty()) return w.bodies[static_cast<std::size_t>(tool.body)].pose.translation();
  if (tool.loop) t = std::fmod(t, path.back().time_s);
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (t > path[i].time_s) continue;
    const double s = std::max(0.0, (t - path[i - 1].time_s) / (path[i].time_s - path[i - 1].time_s));
    return (1 - s) * to_eigen(path[i - 1].position_m) + s * to_eigen(path[i].position_m);
  }
  return to_eigen(path.back().position_m);
}

Settings settings_of(const WorldDef& world, const std::string& engine = "parts") {
  Settings settings;
  settings.visual_thread = "none";  // the ticks are not paced: a separate thread would be late
  REQUIRE(sync::apply_settings(settings, setting_fields(), "sim_node", world.settings, {"engine=" + engine}).empty());
  REQUIRE(apply_engine(settings) == "");
  return settings;
}

}  // namespace

TEST_CASE("Every scene loads without a warning, shows something, and has a hand that can touch something") {
  REQUIRE(scenes().size() >= 8);
  for (const auto& file : scenes()) {
    INFO(file.filename());
    std::vector<std::string> warnings;
    const WorldDef w = load_sdf(file, warnings);
    CHECK(warnings == std::vector<std::string>{});
    CHECK(!w.visuals.empty());
    CHECK(w.tools.size() >= 1);
    for (const ShapeDef& s : w.shapes) CHECK(s.material >= 0);
  }
}

TEST_CASE(
    "Every scene runs for two seconds with each engine: bodies touch, none falls out or flies apart, and no solver "
    "complains") {
  const std::string engine = GENERATE("parts", "ode");
  constexpr double kFastest_m_s = 6, kFarthest_m = 3;  // a fall of 1.8 m; no scene is larger
  for (const auto& file : scenes()) {
    INFO(file.filename() << " with engine = " << engine);
    std::vector<std::string> warnings;
    const WorldDef w = load_sdf(file, warnings);
    Simulation s(w, settings_of(w, engine));
    s.start(11);
    solver_failures = 0;
    dSetMessageHandler([](int, const char*, va_list) { ++solver_failures; });
    sim::test::Hand hand{.radius = w.tools[0].radius_m, .stiffness = 500, .last = along(w, w.tools[0], 0)};
    double fastest = 0, farthest = 0;
    std::size_t begins = 0, contacts = 0;
    std::vector<contact_t> live;
    for (int i = 0; i < 2000; ++i) {
      const std::int64_t now_ns = sync::to_ns(s.now());
      s.step(std::vector{hand.tick(s.touch_models()[0], along(w, w.tools[0], now_ns * 1e-9), now_ns)});
      for (const contact_event_t& e : s.events()) begins += e.kind == contact_event_t::BEGIN;
      for (std::size_t b = 0; b < w.bodies.size(); ++b) {
        if (w.bodies[b].is_static || w.bodies[b].tool >= 0) continue;
        fastest = std::max(fastest, s.bodies()[b].velocity_m_s.norm());
        farthest = std::max(farthest, s.bodies()[b].position_m.norm());
      }
      if (i % 100 == 0)
        s.body_contacts(live), contacts = std::max(contacts, live.size() + s.tool_contacts().size());
    }
    CHECK(begins > 0);
    CHECK(contacts > 0);
    CHECK(fastest < kFastest_m_s);
    CHECK(farthest < kFarthest_m);
    CHECK(solver_failures == 0);
    if (dynamic_cast<const SingleGroup*>(&s.mechanics())) CHECK(sim::test::largest_joint_gap_m(w, s.bodies()) < 0.005);
  }
}

TEST_CASE("The stack scene stays finite in two groups, also if a contact has no direction") {
  if (!make_fcl_detector()) return;
  std::vector<std::string> warnings;
  const WorldDef w = load_sdf(source_dir() + "/sim_node/scenes/stack.sdf", warnings);
  Settings settings = settings_of(w);
  settings.groups = "dual";
  settings.detector = "fcl";
  Simulation s(w, settings);
  s.start(11);
  for (int i = 0; i < 1000; ++i) s.step({});
  for (const BodyMotion& m : s.bodies()) CHECK((m.position_m.allFinite() && m.orientation.coeffs().allFinite()));
}

TEST_CASE(
    "Pushing each ball of the dark room into its own hole wins the game with each engine") {
  const std::string engine = GENERATE("parts", "tactus", "ode");
  INFO("engine = " << engine);
  std::vector<std::string> warnings;
  const WorldDef w = load_sdf(source_dir() + "/sim_node/scenes/dark_room.sdf", warnings);
  REQUIRE(w.holes.size() == 3);
  Simulation s(w, settings_of(w, engine));
  s.start(11);
  sim::test::Hand hand{.radius = 0.008, .stiffness = 500, .last = {-0.3, 0, 0.15}};
  Vector3d device(-0.3, 0, 0.15);
  game_state_t game{};
  // Moves there at 0.25 m/s and returns the number of filled holes.
  const auto move = [&](const Vector3d& to) {
    for (int i = 0; i < 4000 && (device - to).norm() > 1e-4; ++i) {
      device += (to - device).normalized() * std::min(0.00025, (to - device).norm());
      s.step(std::vector{hand.tick(s.touch_models()[0], device, sync::to_ns(s.now()))});
    }
    s.game().describe(game);
    return game.holes[0].filled + game.holes[1].filled + game.holes[2].filled;
  };
  const auto wait = [&](double seconds) {
    for (int i = 0; i < seconds * 1000; ++i)
      s.step(std::vector{hand.tick(s.touch_models()[0], device, sync::to_ns(s.now()))});
    return move(device);
  };
  CHECK(wait(3) == 0);
  int filled = 0;
  for (const HoleDef& hole : w.holes) {
    // Behind the ball as seen from its hole; then through it, repeatedly: a hand learns where it rolled.
    for (int tries = 0; tries < 6; ++tries) {
      const Vector3d ball = s.bodies()[static_cast<std::size_t>(hole.ball)].position_m;
      if (ball.z() < 0) break;
      const Vector3d aim =
          Vector3d(hole.position_m.x() - ball.x(), hole.position_m.y() - ball.y(), 0).normalized();
      const Vector3d behind = ball - 0.075 * aim;
      move({device.x(), device.y(), 0.15});
      move({behind.x(), behind.y(), 0.15});
      move({behind.x(), behind.y(), ball.z()});
      move({hole.position_m.x() - 0.02 * aim.x(), hole.position_m.y() - 0.02 * aim.y(), ball.z()});
      move({device.x(), device.y(), 0.15});
      wait(1);
    }
    INFO(hole.name);
    CHECK(wait(0.3) == ++filled);
    CHECK(s.game().won() == (filled == 3));
  }
  CHECK(game.won == 1);
  CHECK(game.won_ns > 0);
  // The right ball in the wrong hole does not count.
  REQUIRE(s.mechanics().set_pose(w.holes[0].ball, Eigen::Isometry3d(Eigen::Translation3d(0.15, 0.3, 0.05))));
  wait(1);
  CHECK(!s.game().won());
  s.game().describe(game);
  CHECK(game.holes[0].filled == 0);
}
