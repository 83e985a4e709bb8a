#include "audio_node/excitation/impact.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/tool_def_t.hpp>

#include "audio_node/excitation/peak.h"
#include "audio_node/excitation/radiation.h"
#include "audio_node/spatial/pan.h"
#include "lcmtypes/vectors.h"
#include "tests/audio_node/support/impact_scene.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;
using std::numbers::pi;

TEST_CASE("The contact time follows the formula of Hertz") {
  // A steel ball of 10 mm radius (32.9 g) on a thick steel plate at 0.1 m/s: by E* = 1.0917e11, T = 2.87 (m^2 / (R
  // E*^2 v))^(1/5).
  const Elastic steel{2e11, 0.29, 7850, 5, 3e-8, 0.6};
  const double e = 2e11 / (1 - 0.29 * 0.29) / 2;
  CHECK(contact_time_s(0.0329, 100, 0.1, steel, steel) ==
        Approx(2.87 * std::pow(0.0329 * 0.0329 / (0.01 * e * e * 0.1), 0.2)));
  SECTION("the contact time falls with the fifth root of the speed") {
    CHECK(contact_time_s(1, 10, 32, steel, steel) == Approx(contact_time_s(1, 10, 1, steel, steel) / 2));
  }
}

TEST_CASE("A source is panned to its direction with the level of its distance") {
  Eigen::Isometry3d listener = Eigen::Isometry3d::Identity();  // faces +x
  const auto stereo_gain = [&](const Eigen::Vector3d& source) { return pan(place_of(listener, source, 0.3)); };
  const auto left = stereo_gain({0, 2, 0}), right = stereo_gain({0, -2, 0}), ahead = stereo_gain({2, 0, 0}), far = stereo_gain({4, 0, 1});
  CHECK(left.left == Approx(0.5));
  CHECK(left.right == Approx(0).margin(1e-7));
  CHECK(right.right == Approx(0.5));
  CHECK(ahead.left == Approx(ahead.right));
  CHECK(std::hypot(far.left, far.right) == Approx(1 / std::sqrt(17.0)));
  CHECK(place_of(listener, {4, 0, 1}, 0.3).distance_m == Approx(std::sqrt(17.0)));
  SECTION("a rotation of the listener rotates the source") {
    listener.rotate(Eigen::AngleAxisd(pi / 2, Eigen::Vector3d::UnitZ()));  // faces +y
    CHECK(stereo_gain({2, 0, 0}).right == Approx(0.5));
  }
  SECTION("a source at the listener has a finite level") { CHECK(stereo_gain({0, 0, 0}).left < 4); }
}

TEST_CASE("The place of a strike is relative to the last set listener, initially that of the scene") {
  Impacts all = impacts_of_scene();
  const contact_event_t ahead = impact_hit(0, 2, 1, 0.1f);  // at (1, 0, 0), which the listener of the scene faces
  const auto place = [&] { return all.strike(ahead, {}).sides[0].place; };
  CHECK(place().direction.isApprox(Eigen::Vector3f::UnitX()));
  Eigen::Isometry3d ear = Eigen::Isometry3d::Identity();
  ear.rotate(Eigen::AngleAxisd(pi / 2, Eigen::Vector3d::UnitZ()));  // faces +y: the hit is to the right
  all.set_listener(ear);
  CHECK(place().direction.isApprox(-Eigen::Vector3f::UnitY()));
  CHECK(place().distance_m == Approx(1));
  ear.translation().x() = -1;  // twice the distance
  all.set_listener(ear);
  CHECK(place().distance_m == Approx(2));
}

TEST_CASE("The sound of a body depends on its shape, size, mass and material") {
  const Impacts all = impacts_of_scene();
  SECTION("a steel bar has its first bending mode at 288 Hz less the correction for its thickness") {
    // (beta r)^2 (1 + 3.1) / 2 = 1.1e-3
    REQUIRE_FALSE(all.body(1).modes.empty());
    CHECK(all.body(1).modes[0].frequency_Hz == Approx(288.2).epsilon(1.5e-3));
    CHECK(all.body(1).modes[0].damping_1_s == Approx(damping_1_s(all.body(1).material, 288)).epsilon(1e-2));
  }
  SECTION("a small steel ball has no audible mode and only clicks") {
    CHECK(all.body(2).modes.empty());
    CHECK(all.strike(impact_hit(0, 2, 1, 0.8f), {}).sides[1].click > 0);
  }
  SECTION("a ball lighter than a solid one is a shell") {
    const double expected = spherical_shell(all.body(4).material, 0.15, {16000, 1})[0].frequency_Hz;
    CHECK(all.body(4).modes[0].frequency_Hz == Approx(expected));
  }
  SECTION("a floor is represented by a patch and does not move as a whole") {
    REQUIRE_FALSE(all.body(0).modes.empty());
    CHECK(all.body(0).mass_kg == Approx(0.5 * 0.5 * 0.03 * 750));
    CHECK(all.strike(impact_hit(0, 2, 1, 0.8f), {}).sides[0].click == 0);
  }
  SECTION("all modes are in the audible range, and at most the maximum number is kept") {
    for (int id = 0; id < 5; ++id) {
      CHECK(all.body(id).modes.size() <= 64);
      for (const Mode& m : all.body(id).modes) {
        CHECK(m.frequency_Hz >= 40);
        CHECK(m.frequency_Hz <= 16000);
        CHECK(m.damping_1_s > 0);
      }
    }
  }
}

TEST_CASE("A tool sounds by its contact shape") {
  scene_t s = impact_scene();
  body_def_t body{};
  body.id = s.body_count++, body.tool = 0;
  s.bodies.push_back(body);
  tool_def_t tool{};
  tool.body = body.id, tool.material = 1, tool.mass_kg = 0.1, tool.radius_m = 0.006;
  s.tools = {tool}, s.tool_count = 1;
  const auto sound = [&] {
    return Impacts(
               s, [](std::int64_t) { return std::nullopt; }, {}, 48000, 1)
        .body(body.id);
  };
  // The lowest mode of a solid steel ball of 6 mm lies at 2.64 c_s / (2 pi a) = 220 kHz (modal.h).
  CHECK(sound().modes.empty());
  CHECK(sound().mass_kg == Approx(0.1));
  CHECK(sound().radius_m == Approx(0.006));
  SECTION("a tool can be a bar") {
    s.tools[0].shape = tool_def_t::BOX;
    s.tools[0].size_m.x = 0.3, s.tools[0].size_m.y = 0.03, s.tools[0].size_m.z = 0.005;
    REQUIRE_FALSE(sound().modes.empty());
    CHECK(sound().modes[0].frequency_Hz == Approx(impacts_of_scene().body(1).modes[0].frequency_Hz));
  }
}

TEST_CASE("A strike on a nodal line excites no mode, and a strike at an unknown place has mean gains") {
  const Impacts all = impacts_of_scene();
  const double length = 0.3;
  contact_event_t blow = impact_hit(0, 1, 0.5f, 0.353f);
  blow.normal.z = 1;
  // The centre of the bar is at (1, 2, 3), and it is rotated about the vertical.
  Eigen::Isometry3d lies = Eigen::Isometry3d::Identity();
  lies.translation() = Eigen::Vector3d(1, 2, 3);
  lies.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  const auto gains = [&](double x_of_length, double z_m = 0.0025) {
    blow.point_m = to_vec3(lies * Eigen::Vector3d((x_of_length - 0.5) * length, 0, z_m));
    return all
        .strike(blow, {},
                [&](int body) -> std::optional<Eigen::Isometry3d> {
                  return body == 1 ? std::optional(lies) : std::nullopt;
                })
        .sides[1]
        .gains;
  };
  const PerMode end = gains(1), node = gains(0.2242), middle = gains(0.5);
  // Fletcher and Rossing, The Physics of Musical Instruments, table 2.1: nodes of the lowest bending at 0.224 L.
  CHECK(std::abs(node[0]) < 2e-3f * std::abs(end[0]));
  CHECK(end[0] * middle[0] < 0);
  const PerMode anywhere = all.gains(1, std::nullopt), somewhere = all.strike(blow, {}).sides[1].gains;
  CHECK(somewhere[0] == anywhere[0]);
  // The end of a free bar moves twice its rms value.
  CHECK(std::abs(end[0]) == Approx(2 * anywhere[0]).epsilon(1e-3));
  SECTION("a strike beside the body counts as on its surface") {
    CHECK(gains(1, 0.1)[0] == Approx(end[0]));
    CHECK(gains(1.5)[0] == Approx(end[0]));
  }
}

TEST_CASE("Hard bodies collide repeatedly within 15 ms in step with their lowest modes, soft bodies once") {
  const Impacts all = impacts_of_scene();
  const auto humps = [](const Strike& s) {
    return std::count_if(s.pulse.begin(), s.pulse.end(), [](const Hump& h) { return h.samples > 0; });
  };
  const Strike hard = all.strike(impact_hit(1, 4, 1, 0.3f, 30), {}), soft = all.strike(impact_hit(0, 3, 0.5f, 0.576f), {});
  REQUIRE(humps(hard) == 5);
  CHECK(humps(soft) == 1);
  double share = 0;
  for (const Hump& h : hard.pulse) share += static_cast<double>(h.share);
  CHECK(share == Approx(1));
  CHECK(hard.pulse[0].share == Approx(0.8));
  for (std::size_t i = 1; i < hard.pulse.size(); ++i) {
    CAPTURE(i, hard.pulse[i].begin);
    CHECK(hard.pulse[i].begin <= 720);
    // A period of one of the modes of the bar or the shell.
    double nearest = 1e9;
    for (const int id : {1, 4})
      for (const Mode& m : all.body(id).modes)
        nearest = std::min(nearest, std::abs(48000 / m.frequency_Hz - hard.pulse[i].begin));
    CHECK(nearest <= 0.5);
  }
  SECTION("the setting micro_collisions 0 disables repeated collisions") {
    Settings settings;
    settings.micro_collisions = 0;
    const Strike none = impacts_of_scene(settings).strike(impact_hit(1, 4, 1, 0.3f, 30), {});
    CHECK(none.pulse[0].share == 1);
  }
}

// Pairs of impacts of the same bodies, of which one is faster by 0.1 to 50 %.
TEST_CASE("No contact event gives a strike with values that are not finite") {
  const Impacts all = impacts_of_scene();
  std::mt19937 random(6);
  const float wild[] = {0, 1e-30f, 1e30f, 1, 3e38f};
  for (int i = 0; i < 2000; ++i) {
    contact_event_t e = impact_hit(static_cast<int>(random() % 9) - 2, static_cast<int>(random() % 9), wild[random() % 5],
                            wild[random() % 5], wild[random() % 5]);
    e.material_a = static_cast<int>(random() % 6) - 2;
    e.point_m.x = wild[random() % 5], e.point_m.y = -wild[random() % 5];
    const Strike s = all.strike(e, {});
    CHECK(s.pulse[0].samples >= 1);
    CHECK(s.pulse[0].samples <= 960);
    CHECK(length_of(s.pulse) <= 960 + 720);
    for (const StrikeSide& side : s.sides) {
      CHECK(std::isfinite(side.impulse));
      CHECK(std::isfinite(side.click));
      CHECK(side.place.direction.allFinite());
      CHECK(side.place.distance_m >= 0.3f);
    }
  }
}

TEST_CASE("A blow 300 km from the origin sounds like the same blow at the origin") {
  const Eigen::Vector3d far(3e5, -2e5, 1e5);
  const auto moved_by = [](const Eigen::Vector3d& shift) {
    scene_t s = impact_scene();
    for (body_def_t& b : s.bodies) b.pose = to_pose(Eigen::Isometry3d(Eigen::Translation3d(shift)));
    s.listener = to_pose(Eigen::Isometry3d(Eigen::Translation3d(shift)));
    return s;
  };
  const auto none = [](std::int64_t) { return std::optional<Extent>(); };
  const Impacts near_impacts(moved_by(Eigen::Vector3d::Zero()), none, Settings{}, 48000, 1), far_impacts(moved_by(far), none, Settings{}, 48000, 1);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 100; ++i) {
    contact_event_t e = impact_hit(0, 1, 1, 0.1f, 100);
    e.normal.z = 1;
    const Eigen::Vector3d place(u(random), u(random), u(random));
    e.point_m = to_vec3(place);
    const Strike here = near_impacts.strike(e, {});
    e.point_m = to_vec3(Eigen::Vector3d(far + place));
    const Strike there = far_impacts.strike(e, {});
    REQUIRE(here.min_audible_gain < 1);
    CHECK(there.min_audible_gain == Approx(here.min_audible_gain).epsilon(1e-5));
    for (std::size_t k = 0; k < 2; ++k) {
      CHECK(there.sides[k].impulse == Approx(here.sides[k].impulse).epsilon(1e-5));
      CHECK((there.sides[k].place.direction - here.sides[k].place.direction).norm() < 1e-6f);
      CHECK(there.sides[k].place.distance_m == Approx(here.sides[k].place.distance_m).epsilon(1e-6));
      Listener ear;
      ear.T_W_listener.translation() = far + Eigen::Vector3d(0.001, 0, 0);
      Listener near_ear;
      near_ear.T_W_listener.translation() = Eigen::Vector3d(0.001, 0, 0);
      const SourcePosition a = relative_to_listener(near_ear, here.sides[k].place), b = relative_to_listener(ear, there.sides[k].place);
      CHECK((a.direction - b.direction).norm() < 1e-5f);
    }
  }
}
