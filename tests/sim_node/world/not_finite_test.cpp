// Tests of a world whose state is not finite: it stops with a sentence.
#include <catch2/catch.hpp>
#include <limits>

#include "sim_node/model/finite_motion.h"
#include "sim_node/world/simulation.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();

// Two balls apart from each other; the second one is "ball 2".
WorldDef two_balls() {
  WorldDef w = empty_world();
  add_floor(w);
  add_ball(w, 1, 0.1, {0, 0, 1});
  w.bodies[static_cast<std::size_t>(add_ball(w, 1, 0.1, {2, 0, 1}))].name = "ball 2";
  return w;
}

}  // namespace

TEST_CASE("Any number that is not finite in the state of a body is found, and named") {
  CHECK(infinite_quantity({}) == nullptr);
  BodyMotion fast;
  fast.velocity_m_s = {1e308, 1e308, 1e308};  // their sum overflows
  CHECK(infinite_quantity(fast) == nullptr);
  for (const double bad : {kNaN, kInf, -kInf})
    for (int axis = 0; axis < 3; ++axis) {
      BodyMotion position, centre, orientation, velocity, spin;
      position.position_m[axis] = centre.centre_m[axis] = orientation.orientation.coeffs()[axis] = velocity.velocity_m_s[axis] = spin.spin_rad_s[axis] = bad;
      CHECK(infinite_quantity(position) == std::string("the position"));
      CHECK(infinite_quantity(centre) == std::string("the position"));
      CHECK(infinite_quantity(orientation) == std::string("the orientation"));
      CHECK(infinite_quantity(velocity) == std::string("the velocity"));
      CHECK(infinite_quantity(spin) == std::string("the spin"));
      CHECK_THROWS_AS(require_finite(7, spin), StateNotFinite);
    }
  BodyMotion both;  // infinities of opposite signs
  both.velocity_m_s = {kInf, -kInf, 0};
  CHECK(infinite_quantity(both) != nullptr);
}

TEST_CASE("A world whose state is not finite stops in that step, with a sentence that names the body and the step") {
  Settings settings;
  settings.groups = GENERATE("single", "dual");
  const Vector3d bad = GENERATE(Vector3d(kNaN, 0, 0), Vector3d(0, 0, kInf));
  Simulation s(two_balls(), settings);
  s.start(11);
  for (int i = 0; i < 20; ++i) s.step({});
  REQUIRE(s.mechanics().set_velocity(2, bad));
  std::string sentence;
  for (int i = 0; i < 3 && sentence.empty(); ++i) try {
      s.step({});
    } catch (const std::runtime_error& e) {
      sentence = e.what();
    }
  CHECK_THAT(sentence, Catch::Contains("of the body ball 2 is not finite after step 2") && Catch::Contains("so the world stops"));
}

TEST_CASE("A state that is not finite in the steps ahead stops the world with its sentence, also on a thread of their own") {
  Settings settings;
  settings.groups = "dual";
  settings.visual_thread = GENERATE("none", "own");
  const bool renames = GENERATE(false, true);
  Simulation s(two_balls(), settings);
  s.start(11);
  for (int i = 0; i < 5; ++i) s.step({});
  REQUIRE(s.mechanics().apply({.kind = impulse::SceneChange::kGravity, .values = {0, 0, kNaN}}));
  std::string sentence;
  for (int i = 0; i < 100 && sentence.empty(); ++i) try {
      s.step({});
      // Both wait for the step ahead.
      if (renames) s.begin_incarnation(12 + i);
      s.save();
    } catch (const std::runtime_error& e) {
      sentence = e.what();
    }
  CHECK_THAT(sentence, Catch::Contains("of the body ball") && Catch::Contains(" is not finite after step ") && Catch::Contains("so the world stops"));
}
