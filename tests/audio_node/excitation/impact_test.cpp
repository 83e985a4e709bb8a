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
#include "audio_node/mixer/renderer.h"
#include "lcmtypes/vectors.h"

using namespace tactus;
using namespace tactus::audio;
using std::numbers::pi;

namespace {

material_def_t material(double E, double nu, double rho, double alpha, double beta) {
  material_def_t m{};
  m.youngs_modulus_Pa = E, m.poissons_ratio = nu, m.density_kg_m3 = rho;
  m.rayleigh_alpha_1_s = alpha, m.rayleigh_beta_s = beta, m.restitution = 0.6;
  return m;
}

void add(scene_t& scene, std::int8_t kind, Eigen::Vector3d size, double mass_kg, int material_index) {
  body_def_t body{};
  body.id = scene.body_count++;
  body.tool = -1;
  body.is_static = mass_kg == 0;
  body.mass_kg = mass_kg;
  shape_def_t shape{};
  shape.body = body.id, shape.kind = kind, shape.size_m = to_vec3(size), shape.material = material_index;
  scene.bodies.push_back(body);
  scene.shapes.push_back(shape);
  scene.shape_count++;
}

// A wooden floor, a steel bar, a steel ball, a rubber ball, a steel shell.
scene_t scene() {
  scene_t s{};
  s.materials = {material(1.1e10, .25, 750, 60, 2e-6), material(2e11, .29, 7850, 5, 3e-8),
                 material(5e6, .48, 1100, 60, 1e-4)};
  s.material_count = 3;
  add(s, shape_def_t::BOX, {6, 6, 0.2}, 0, 0);
  add(s, shape_def_t::BOX, {0.3, 0.03, 0.005}, 0.353, 1);
  add(s, shape_def_t::SPHERE, {0.03, 0, 0}, 0.888, 1);
  add(s, shape_def_t::SPHERE, {0.05, 0, 0}, 0.576, 2);
  add(s, shape_def_t::SPHERE, {0.15, 0, 0}, 4, 1);
  s.listener.orientation.w = 1;
  return s;
}

contact_event_t hit(int a, int b, float speed, float mass, float curvature = 30) {
  contact_event_t e{};
  e.event_id = 5, e.kind = contact_event_t::HIT, e.body_a = a, e.body_b = b, e.material_a = e.material_b = -1;
  e.approach_speed_m_s = speed, e.effective_mass_kg = mass, e.curvature_1_m = curvature;
  e.point_m.x = 1;
  return e;
}

Impacts impacts(const Settings& settings = {}) {
  return Impacts(
      scene(), [](std::int64_t) { return std::nullopt; }, settings, 48000, 1);
}

// Sound of one strike for a listener 1 m ahead, both channels in turn, with the whole rendering of the callback.
std::vector<double> rendered(const Strike& strike) {
  auto queues = std::make_unique<CallbackQueues>();
  auto renderer = std::make_unique<Renderer>(*queues, RendererDef{});
  Strike at_once = strike;
  at_once.scheduled = sync::host_time(10'000'000);
  queues->strikes.push(at_once);
  std::vector<float> x(2 * 4800);
  renderer->render(x.data(), 4800, {});
  return {x.begin(), x.end()};
}
double largest(const std::vector<double>& x) {
  double peak = 0;
  for (const double s : x) peak = std::max(peak, std::abs(s));
  return peak;
}
double rms(const std::vector<double>& x) {
  double sum = 0;
  for (const double s : x) sum += s * s;
  return std::sqrt(sum / static_cast<double>(x.size()));
}

}  // namespace

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
  Impacts all = impacts();
  const contact_event_t ahead = hit(0, 2, 1, 0.1f);  // at (1, 0, 0), which the listener of the scene faces
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
  const Impacts all = impacts();
  SECTION("a steel bar has its first bending mode at 288 Hz less the correction for its thickness") {
    // (beta r)^2 (1 + 3.1) / 2 = 1.1e-3
    REQUIRE_FALSE(all.body(1).modes.empty());
    CHECK(all.body(1).modes[0].frequency_Hz == Approx(288.2).epsilon(1.5e-3));
    CHECK(all.body(1).modes[0].damping_1_s == Approx(damping_1_s(all.body(1).material, 288)).epsilon(1e-2));
  }
  SECTION("a small steel ball has no audible mode and only clicks") {
    CHECK(all.body(2).modes.empty());
    CHECK(all.strike(hit(0, 2, 1, 0.8f), {}).sides[1].click > 0);
  }
  SECTION("a ball lighter than a solid one is a shell") {
    const double expected = spherical_shell(all.body(4).material, 0.15, {16000, 1})[0].frequency_Hz;
    CHECK(all.body(4).modes[0].frequency_Hz == Approx(expected));
  }
  SECTION("a floor is represented by a patch and does not move as a whole") {
    REQUIRE_FALSE(all.body(0).modes.empty());
    CHECK(all.body(0).mass_kg == Approx(0.5 * 0.5 * 0.03 * 750));
    CHECK(all.strike(hit(0, 2, 1, 0.8f), {}).sides[0].click == 0);
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

TEST_CASE("Doubling the impulse doubles the sound pressure") {
  const Impacts all = impacts();
  std::mt19937 random(21);
  const auto draw = [&](double from, double to) { return from * std::pow(to / from, std::uniform_real_distribution<double>(0, 1)(random)); };
  int clear = 0, heard = 0;
  for (int i = 0; i < 200; ++i) {
    const int a = static_cast<int>(random() % 5), b = (a + 1 + static_cast<int>(random() % 4)) % 5;
    const double mass = draw(1e-3, 1), speed = draw(0.02, 1), curvature = draw(5, 1000);
    // At twice the speed and twice the curvature the contact time is the same: T ~ (m^2 k / v)^(1/5).
    const Strike once = all.strike(hit(a, b, static_cast<float>(speed), static_cast<float>(mass), static_cast<float>(curvature)), {});
    const Strike twice = all.strike(hit(a, b, static_cast<float>(2 * speed), static_cast<float>(mass), static_cast<float>(2 * curvature)), {});
    CAPTURE(a, b, mass, speed, curvature);
    REQUIRE(twice.impulse_N_s == Approx(2 * once.impulse_N_s));
    const double limit = 4 * Settings{}.reference_level;
    if (peak_Pa(twice, 48000) > 0.99 * limit) continue;  // 12 dB above the reference
    ++clear;
    CHECK(peak_Pa(twice, 48000) / peak_Pa(once, 48000) == Approx(2).epsilon(1e-3));
    // A voice ends below -100 dBFS, which shortens weak sounds, and the limits of peak and level reduce loud ones.
    if (peak_Pa(once, 48000) < 0.01 || peak_Pa(twice, 48000) > 0.25 || i % 5) continue;
    ++heard;
    CHECK(largest(rendered(twice)) / largest(rendered(once)) == Approx(2).epsilon(1e-3));
    CHECK(rms(rendered(twice)) / rms(rendered(once)) == Approx(2).epsilon(1e-3));
  }
  CHECK(clear > 100);
  CHECK(heard > 10);
}

TEST_CASE("The level of an impact is its pressure, in proportion or compressed by loudness_exponent") {
  Settings settings;
  settings.loudness_exponent = GENERATE(1.0, 0.6);
  const Impacts all = impacts(settings);
  const auto rendered_peak = [&](const contact_event_t& e) { return largest(rendered(all.strike(e, {}))); };
  // With the same spectrum (same contact time: speed 1 and mass 1 against mass 4 and speed 16, T ~ (m^2/v)^(1/5))
  // the pressure is 64 times as large.
  const double weak = rendered_peak(hit(0, 1, 0.02f, 0.001f)), strong = rendered_peak(hit(0, 1, 0.32f, 0.004f));
  CHECK(strong / weak == Approx(std::pow(64, settings.loudness_exponent)).epsilon(0.02));
  CHECK(all.strike(hit(0, 1, 0.0001f, 1e-6f), {}).min_audible_gain > 1);
  CHECK_FALSE(all.strike(hit(0, 1, 0.5f, 0.1f), {}).min_audible_gain > 1);
}

TEST_CASE("The level of an impact without audible modes is the pressure of the clicks of its two bodies") {
  // Two steel balls of 3 cm and 0.888 kg, whose lowest mode is at 2.645 c_s / (2 pi a) = 44 kHz.
  scene_t s = scene();
  add(s, shape_def_t::SPHERE, {0.03, 0, 0}, 0.888, 1);
  const Impacts all(
      s, [](std::int64_t) { return std::nullopt; }, {}, 48000, 1);
  REQUIRE(all.body(2).modes.empty());
  const double mass = 0.444, curvature = 67;
  for (const double speed : {0.05, 0.5}) {
    const double length_s = contact_time_s(mass, curvature, speed, all.body(2).material, all.body(5).material);
    REQUIRE(length_s > 2 / 48000.);
    const double change_m_s = mass * speed * (1 + 0.6) / 0.888;  // restitution 0.6
    const double pressure = 2 * acceleration_peak_Pa(change_m_s, length_s, 0.03);
    CAPTURE(speed, pressure, length_s);
    const Settings settings;
    const Strike strike = all.strike(hit(2, 5, static_cast<float>(speed), static_cast<float>(mass), static_cast<float>(curvature)), {});
    CHECK(peak_Pa(strike, 48000) == Approx(settings.reference_level * pressure / settings.reference_pressure_Pa).epsilon(1e-3));
  }
}

TEST_CASE("Impacts of hard bodies are louder than those of soft ones") {
  const Impacts all = impacts();
  const auto rendered_peak = [&](const contact_event_t& e) { return largest(rendered(all.strike(e, {}))); };
  for (const int id : {1, 2, 4}) {
    const double peak = rendered_peak(hit(0, id, 0.5f, static_cast<float>(all.body(id).mass_kg), 100));
    CAPTURE(id, peak);
    CHECK(peak > 0.05);
    CHECK(peak < 0.71);
  }
  SECTION("a rubber ball is much softer: its pulse is too long for modes, and its own jerk is the lower bound") {
    const contact_event_t blow = hit(0, 3, 0.5f, static_cast<float>(all.body(3).mass_kg), 100);
    const double length_s = all.strike(blow, {}).pulse[0].samples / 48000.0;
    REQUIRE(length_s > 0.01);
    const double jerk_Pa = acceleration_peak_Pa(0.5 * 1.6, length_s, 0.05);
    CHECK(rendered_peak(blow) > 0.25 * jerk_Pa / 10);
    CHECK(rendered_peak(blow) < rendered_peak(hit(0, 2, 0.5f, 0.576f, 100)) / 4);
  }
}

TEST_CASE("A tool sounds by its contact shape") {
  scene_t s = scene();
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
    CHECK(sound().modes[0].frequency_Hz == Approx(impacts().body(1).modes[0].frequency_Hz));
  }
}

TEST_CASE("A strike on a nodal line excites no mode, and a strike at an unknown place has mean gains") {
  const Impacts all = impacts();
  const double length = 0.3;
  contact_event_t blow = hit(0, 1, 0.5f, 0.353f);
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
  const Impacts all = impacts();
  const auto humps = [](const Strike& s) {
    return std::count_if(s.pulse.begin(), s.pulse.end(), [](const Hump& h) { return h.samples > 0; });
  };
  const Strike hard = all.strike(hit(1, 4, 1, 0.3f, 30), {}), soft = all.strike(hit(0, 3, 0.5f, 0.576f), {});
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
    const Strike none = impacts(settings).strike(hit(1, 4, 1, 0.3f, 30), {});
    CHECK(none.pulse[0].share == 1);
  }
}

// Pairs of impacts of the same bodies, of which one is faster by 0.1 to 50 %.
TEST_CASE("An impact is never quieter than a slower one of the same bodies, also where repeated collisions set in") {
  const Impacts all = impacts();
  std::mt19937 random(13);
  const auto draw = [&](double from, double to) { return from * std::pow(to / from, std::uniform_real_distribution<double>(0, 1)(random)); };
  int repeated = 0, falls = 0;
  double largest_fall = 0;
  for (int i = 0; i < 1500; ++i) {
    const int a = static_cast<int>(random() % 5), b = (a + 1 + static_cast<int>(random() % 4)) % 5;
    const double mass = draw(1e-3, 1), speed = draw(0.02, 5), curvature = draw(5, 2000), faster = speed * (1 + draw(1e-3, 0.5));
    const auto peak = [&](double v) {
      const Strike s = all.strike(hit(a, b, static_cast<float>(v), static_cast<float>(mass), static_cast<float>(curvature)), {});
      repeated += s.pulse[1].samples > 0;
      return peak_Pa(s, 48000);  // as played: its sides are scaled
    };
    const double slow = peak(speed), fast = peak(faster);
    falls += fast < slow * (1 - 1e-3);
    largest_fall = std::max(largest_fall, 1 - fast / slow);
  }
  CAPTURE(largest_fall);
  CHECK(repeated > 300);
  CHECK(falls == 0);
}

TEST_CASE("No contact event gives a strike with values that are not finite") {
  const Impacts all = impacts();
  std::mt19937 random(6);
  const float wild[] = {0, 1e-30f, 1e30f, 1, 3e38f};
  for (int i = 0; i < 2000; ++i) {
    contact_event_t e = hit(static_cast<int>(random() % 9) - 2, static_cast<int>(random() % 9), wild[random() % 5],
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
    scene_t s = scene();
    for (body_def_t& b : s.bodies) b.pose = to_pose(Eigen::Isometry3d(Eigen::Translation3d(shift)));
    s.listener = to_pose(Eigen::Isometry3d(Eigen::Translation3d(shift)));
    return s;
  };
  const auto none = [](std::int64_t) { return std::optional<Extent>(); };
  const Impacts near_impacts(moved_by(Eigen::Vector3d::Zero()), none, Settings{}, 48000, 1), far_impacts(moved_by(far), none, Settings{}, 48000, 1);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 100; ++i) {
    contact_event_t e = hit(0, 1, 1, 0.1f, 100);
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
