#include "audio_node/excitation/sliding.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <tactus/world_state_t.hpp>

#include "audio_node/excitation/contact_patch.h"
#include "audio_node/mixer/scrapes.h"
#include "lcmtypes/vectors.h"
#include "tests/audio_node/support/waves.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;
using Eigen::Vector3d;
namespace {
constexpr std::int64_t kRun = 1, kMs = 1'000'000;

// Of body 1 relative to body 0, which has the map.
contact_t sliding(const Vector3d& velocity_m_s, double force_N, const Vector3d& place_body,
                  const Vector3d& normal = Vector3d::UnitZ()) {
  contact_t c{};
  c.contact_id = 5, c.kind = contact_t::POINT, c.body_a = 0, c.body_b = 1, c.material_a = 0, c.material_b = 1,
  c.tool = 0;
  c.normal = to_vec3f(normal);
  c.normal_force_N = static_cast<float>(force_N);
  c.sliding_velocity_m_s = to_vec3f(velocity_m_s);
  c.point_count = 1, c.points.resize(1);
  c.points[0].a_body_m = to_vec3(place_body);
  return c;
}

// Rotated by 90 degrees about z, so that +y of the world is +x of the board.
scene_t board(bool stands) {
  scene_t s{};
  s.listener = to_pose(Eigen::Isometry3d::Identity());
  s.bodies.resize(2), s.body_count = 2;
  s.bodies[0].is_static = stands ? 1 : 0, s.bodies[1].id = 1;
  s.bodies[0].pose = to_pose(Eigen::Isometry3d(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ())));
  s.bodies[1].mass_kg = 1;
  s.materials = {rough(), material_def_t{}}, s.material_count = 2;
  s.materials[1].friction_dynamic = 0.5;
  // Of wood, by the omitted material.
  s.shapes.resize(2), s.shape_count = 2;
  for (shape_def_t& shape : s.shapes)
    shape.kind = shape_def_t::BOX, shape.pose = to_pose(Eigen::Isometry3d::Identity());
  s.shapes[0].size_m = to_vec3({0.3, 0.3, 0.02}), s.shapes[1].size_m = to_vec3({0.2, 0.03, 0.02});
  s.shapes[1].body = s.shapes[1].material = 1;
  return s;
}

// Orientation of the board, as the simulation publishes it.
world_state_t published_pose(std::int64_t ms, const Eigen::Quaterniond& orientation,
                   const Vector3d& spin_rad_s = Vector3d::Zero()) {
  world_state_t m{};
  m.header.run_id = kRun, m.header.incarnation = 7, m.header.seq = ms;
  m.header.sim_time_ns = m.header.publish_time_ns = ms * kMs;
  m.clock = {ms * kMs, ms * kMs, 1};
  m.rate_Hz = 60, m.pages = 1, m.count = 1;
  m.bodies.resize(1);
  m.bodies[0].orientation = to_quatf(orientation);
  m.bodies[0].angular_velocity_rad_s = to_vec3f(spin_rad_s);
  return m;
}

sync::SimTime sim_ms(std::int64_t ms) { return sync::sim_time(ms * kMs); }

// With the bodies of a scene, which sound, and a clock that advances by 1 ms with each update.
struct SlidingBench {
  explicit SlidingBench(const scene_t& of, std::shared_ptr<const AudioSurfaces> surfaces = wavy_surfaces(),
                 const Settings& settings = {})
      : scene(of),
        impacts(
            of, [](std::int64_t) { return std::nullopt; }, settings, 48000, 1),
        slides(of, std::move(surfaces), bodies, impacts, settings, 48000) {}
  std::vector<Scrape> step(const contact_t& c) {
    now_ms += 1;
    return slides.scrapes({c}, sim_ms(now_ms), at_ms(static_cast<double>(now_ms)), 0.001);
  }
  scene_t scene;
  Impacts impacts;
  sync::BodyHistory bodies{kRun};
  Sliding slides;
  std::int64_t now_ms = 500;
};

Eigen::Quaterniond turn(double rad, const Vector3d& axis = Vector3d::UnitZ()) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(rad, axis));
}

}  // namespace

TEST_CASE("A scrape has its place on both bodies, its velocity and its strength") {
  SlidingBench h(board(true));
  const Vector3d place(0.005, 0.003, 0), velocity(0, 0.1, 0);
  const auto all = h.step(sliding(velocity, 2, place));
  REQUIRE(all.size() == 1);
  const Scrape s = all[0];
  const ScrapeSide &side = s.sides[0], &other = s.sides[1];
  CHECK(side.known);
  CHECK(side.relief != nullptr);
  CHECK((side.place_m - place).norm() < 1e-7);
  CHECK((side.velocity_m_s - Vector3d(0.1, 0, 0)).norm() < 1e-6);
  CHECK(side.slide_vector.x() == Approx(1));
  CHECK(side.roll_vector.norm() == 0);
  CHECK(side.voice == h.impacts.voice_id(0));
  CHECK(side.resonators.count > 0);
  CHECK(other.voice == h.impacts.voice_id(1));
  CHECK(other.resonators.count > 0);
  CHECK_FALSE(other.known);
  CHECK(s.slide > 0);
  CHECK(s.roll == 0);
}

TEST_CASE("The strength of sliding is the root of the friction power") {
  // Strength is proportional to the root of friction, force and speed (FoleyAutomatic, section 4.2).
  CHECK(sliding_strength(0.5, 2, 0.1) == Approx(std::sqrt(0.1)));
  const double force_N = GENERATE(0.5, 8.0), speed_m_s = GENERATE(0.05, 0.4);
  const auto scrape_at = [&](double force, double speed) {
    SlidingBench h(board(true));
    return h.step(sliding({0, speed, 0}, force, {0.005, 0.003, 0})).at(0);
  };
  const double one = static_cast<double>(scrape_at(2, 0.1).slide),
               other = static_cast<double>(scrape_at(force_N, speed_m_s).slide);
  CHECK(other / one == Approx(std::sqrt(force_N * speed_m_s / 0.2)).epsilon(1e-4));
}

TEST_CASE("The level of the reference stroke is its expected pressure, in proportion or compressed by loudness_exponent") {
  const double exponent = GENERATE(1.0, 0.6);
  const auto strength_at = [&](double force_N, double friction_level) {
    Settings settings;
    settings.scrape_force_N = force_N, settings.loudness_exponent = exponent, settings.friction_level = friction_level;
    SlidingBench h(board(true), wavy_surfaces(), settings);
    return static_cast<double>(h.step(sliding({0, 0.1, 0}, 1, {0.005, 0.003, 0})).at(0).slide);
  };
  // Twice the force per slope, and so twice the expected pressure; twice the level of friction is the same.
  CHECK(strength_at(80, 16) / strength_at(40, 16) == Approx(std::pow(2, exponent)).epsilon(1e-4));
  CHECK(strength_at(40, 16) / strength_at(40, 8) == Approx(std::pow(2, exponent)).epsilon(1e-4));
}

TEST_CASE("A contact that rests under load is silent although it jitters, and sliding is audible at once") {
  SlidingBench h(board(true));
  const Vector3d place(0.005, 0.003, 0);
  CHECK(h.step(sliding(Vector3d::Zero(), 10, place)).empty());
  for (int ms = 0; ms < 200; ++ms) REQUIRE(h.step(sliding({0, ms % 2 ? 0.01 : -0.01, 0}, 10, place)).empty());
  for (int ms = 0; ms < 200; ++ms) REQUIRE(h.step(sliding({0, 0.0009, 0}, 10, place)).empty());  // creeps
  CHECK(h.step(sliding({0, 0.1, 0}, 10, place)).at(0).slide > 0);
  SECTION("a contact ends once when it comes to rest or is removed") {
    const bool rests = GENERATE(true, false);
    int ends = 0, later = 0;
    for (int ms = 0; ms < 100; ++ms) {
      const auto all = rests ? h.step(sliding(Vector3d::Zero(), 10, place))
                             : h.slides.scrapes({}, sim_ms(900), at_ms(900), 0.001);
      for (const Scrape& s : all) (s.ends ? ends : later) += 1;
    }
    CHECK(ends == 1);
    // Its path of 0.1 mm decays within ln(5) 20 ms.
    CHECK(later <= (rests ? 33 : 0));
  }
}

TEST_CASE("Surfaces without a map scrape by the roughness of their materials") {
  SlidingBench h(board(true), std::make_shared<AudioSurfaces>());
  const Scrape s = h.step(sliding({0, 0.1, 0}, 2, {0.005, 0.003, 0})).at(0);
  CHECK(s.sides[0].relief == nullptr);
  CHECK(s.sides[0].roughness.height_m > 0);
  CHECK(s.slide > 0);
}

TEST_CASE("A moving body scrapes by its current orientation and is silent until that is known") {
  SlidingBench h(board(false));
  const contact_t along_y = sliding({0, 0.1, 0}, 2, {0.005, 0.003, 0});
  CHECK(h.step(along_y).empty());
  SECTION("rotated about the normal") {
    h.bodies.push(published_pose(500, turn(M_PI / 2)), at_ms(500));
    CHECK(h.step(along_y).at(0).sides[0].slide_vector.x() == Approx(1).margin(1e-3));
    SECTION("after a further rotation the path over the map has another direction") {
      h.bodies.push(published_pose(600, turn(M_PI)), at_ms(600));
      h.now_ms = 600;
      const ScrapeSide side = h.step(along_y).at(0).sides[0];
      CHECK(std::abs(side.slide_vector.x()) < 0.05f);
      CHECK(side.slide_vector.y() == Approx(-1).epsilon(1e-3));
    }
  }
  SECTION("rotated onto another side, whose map has other axes") {
    // +y of the body is up, so u grows along its z, and its z is along -y of the world.
    h.bodies.push(published_pose(500, turn(M_PI / 2, Vector3d::UnitX())), at_ms(500));
    const ScrapeSide side = h.step(sliding({0, 0.1, 0}, 2, {0.003, 0.01, 0.005})).at(0).sides[0];
    CHECK(side.axes.across == 1);
    CHECK(side.axes.u == 2);
    CHECK(side.slide_vector.z() == Approx(-1));
  }
  SECTION("the moving body is the second of the two") {
    h.bodies.push(published_pose(500, turn(M_PI / 2)), at_ms(500));
    contact_t c = along_y;
    std::swap(c.body_a, c.body_b), std::swap(c.material_a, c.material_b);
    std::swap(c.points[0].a_body_m, c.points[0].b_body_m);
    const ScrapeSide side = h.step(c).at(0).sides[1];
    CHECK(side.slide_vector.x() == Approx(-1));
    CHECK(side.place_m.x() == Approx(0.005));
  }
}

TEST_CASE("A finger on a rotating board moves over the map at the speed of the received places") {
  // Two thirds of a revolution a second under a finger that stays; the board is published at 60 Hz, the finger at
  // 1 kHz.
  const double spin_rad_s = 4, radius_m = 0.03;
  SlidingBench h(board(false));
  Vector3d gone = Vector3d::Zero(), began = Vector3d::Zero();
  for (std::int64_t ms = 0; ms <= 500; ++ms) {
    const double rad = 1e-3 * spin_rad_s * static_cast<double>(ms);
    h.now_ms = ms - 1;
    if (ms % 17 == 0) h.bodies.push(published_pose(ms, turn(rad), {0, 0, spin_rad_s}), sync::host_time(ms * kMs));
    const Vector3d finger(radius_m, 0, 0), board = Vector3d(0, 0, spin_rad_s).cross(finger);
    const contact_t c = sliding(-board, 2, turn(rad).conjugate() * finger);
    const ScrapeSide side = h.step(c).at(0).sides[0];
    if (ms == 0) began = side.place_m;
    // Extrapolated with the previous velocity; an error of half a tick of a circle, of 60 waves in total.
    REQUIRE((began + gone - side.place_m).norm() < 0.06 * kWave_m);
    gone += 1e-3 * side.velocity_m_s;
  }
}

TEST_CASE(
    "The path over a map is steady with updates at 60 Hz, and has no length under an edge of the mapped body") {
  SlidingBench h(board(false));
  h.bodies.push(published_pose(0, turn(0)), sync::host_time(0));
  h.now_ms = -1;
  const bool own_edge = GENERATE(false, true);
  const double speed_m_s = 0.2;
  Scrape s;
  double before_m = 0;
  for (std::int64_t ms = 0; ms < 500; ++ms) {
    const double received_m = own_edge ? 0.02 : 1e-3 * speed_m_s * static_cast<double>(ms - ms % 17);
    contact_t c = sliding({speed_m_s, 0, 0}, 2, {received_m, 0, 0});
    // The other corners of the body; from time to time another one is deepest.
    c.points.resize(2), c.point_count = 2;
    c.points[1].a_body_m = to_vec3(Vector3d(received_m + 0.1, 0.05, 0));
    if (ms % 34 >= 17) std::swap(c.points[0], c.points[1]);
    s = h.step(c).at(0);
    if (own_edge) continue;
    const ScrapeSide& side = s.sides[0];
    REQUIRE(side.velocity_m_s.x() == Approx(speed_m_s).epsilon(0.01));
    // Moves between two snapshots, never back to the previous one.
    if (ms > 0) REQUIRE(side.place_m.x() - before_m == Approx(1e-3 * speed_m_s).epsilon(0.2));
    REQUIRE(side.place_m.x() == Approx(1e-3 * speed_m_s * static_cast<double>(ms)).margin(1e-3 * speed_m_s));
    before_m = side.place_m.x();
  }
  if (own_edge) {
    // The initial value has decayed: nine updates of 50 ms each.
    CHECK(s.sides[0].velocity_m_s.norm() < 0.001 * speed_m_s);
    CHECK(s.sides[1].velocity_m_s.norm() == 0);  // its orientation is not known
    CHECK(s.slide > 0);
  }
}

TEST_CASE(
    "A rolling ball repeats the sound of its circumference, once per revolution louder, and low-passed by its patch") {
  // Of 20 mm, on a floor, 1.6 revolutions a second.
  const double radius_m = 0.02, spin_rad_s = 10, speed_m_s = radius_m * spin_rad_s, force_N = 0.5;
  scene_t scene = board(true);
  scene.bodies[0].pose = to_pose(Eigen::Isometry3d::Identity());
  scene.shapes[1].kind = shape_def_t::SPHERE, scene.shapes[1].size_m.x = radius_m;
  Settings settings;
  settings.turn_depth = 0.5;
  SlidingBench h(scene, std::make_shared<AudioSurfaces>(), settings);
  h.now_ms = -1;
  std::vector<double> strong;
  std::vector<Vector3d> places;
  Scrape s;
  for (std::int64_t ms = 0; ms < 1500; ++ms) {
    const double t = 1e-3 * static_cast<double>(ms), rad = spin_rad_s * t;
    const Eigen::Quaterniond lies = turn(rad, Vector3d::UnitY());
    if (ms % 17 == 0) {
      world_state_t m = published_pose(ms, lies, {0, spin_rad_s, 0});
      m.bodies[0].body = 1;
      m.bodies[0].position_m = to_vec3(Vector3d(speed_m_s * t, 0, radius_m));
      h.bodies.push(m, sync::host_time(ms * kMs));
    }
    const double then = 1e-3 * static_cast<double>(ms - ms % 17);
    contact_t c = sliding(Vector3d::Zero(), force_N, {speed_m_s * then, 0, 0});
    c.tool = -1;
    c.rolling_velocity_m_s = to_vec3f(Vector3d(speed_m_s, 0, 0));
    c.points[0].a_world_m = c.points[0].a_body_m;
    c.points[0].b_body_m =
        to_vec3(turn(spin_rad_s * then, Vector3d::UnitY()).conjugate() * Vector3d(0, 0, -radius_m));
    const auto all = h.step(c);
    REQUIRE(all.size() == (ms > 0 || !all.empty() ? 1 : 0));
    s = all[0];
    CHECK(s.slide == 0);
    strong.push_back(static_cast<double>(s.roll));
    places.push_back(s.sides[1].place_m);
  }
  CHECK(s.sides[0].roll_vector.x() == Approx(1));
  CHECK(s.sides[1].roll_vector.norm() == Approx(1));
  CHECK(s.sides[1].velocity_m_s.norm() == Approx(speed_m_s));
  const double reduced = reduced_modulus_Pa(elastic(scene.materials[0]), elastic(scene.materials[1]));
  CHECK(s.cutoff_Hz == Approx(speed_m_s / (2 * std::cbrt(3 * force_N * radius_m / (4 * reduced)))));
  // From the second half second on: the same place of the ball after a revolution, within the distance that it
  // rolls in 2 ms.
  const auto turn_ms = static_cast<std::size_t>(std::lround(2000 * M_PI / spin_rad_s));
  for (std::size_t ms = 500; ms + turn_ms < places.size(); ++ms)
    REQUIRE((places[ms + turn_ms] - places[ms]).norm() < 0.002 * speed_m_s);
  // The heavy side (2, -1, 2) / 3 rotates by sqrt(8) / 3.
  const auto [least, most] =
      std::minmax_element(strong.begin() + 700, strong.begin() + 700 + static_cast<long>(turn_ms));
  const double depth = settings.turn_depth * std::sqrt(8.0) / 3;
  CHECK(*most / *least == Approx((1 + depth) / (1 - depth)).epsilon(0.01));
  for (std::size_t ms = 500; ms + turn_ms < strong.size(); ++ms)
    REQUIRE(strong[ms + turn_ms] == Approx(strong[ms]).epsilon(0.01));
}

TEST_CASE("The strength of rolling is limited by inertia at low speed and by the load") {
  scene_t scene = board(true);
  scene.shapes[1].kind = shape_def_t::SPHERE, scene.shapes[1].size_m.x = 0.02;
  const auto rolls = [&](double force_N, double speed_m_s) {
    SlidingBench h(scene, std::make_shared<AudioSurfaces>());
    contact_t c = sliding(Vector3d::Zero(), force_N, Vector3d::Zero());
    c.tool = -1;
    c.rolling_velocity_m_s = to_vec3f(Vector3d(speed_m_s, 0, 0));
    Scrape s;
    for (int ms = 0; ms < 200; ++ms)  // moved far enough to be detected
      for (const Scrape& last : h.step(c)) s = last;
    return static_cast<double>(s.roll);
  };
  // Of 1 kg at millimetres a second: with the square of the speed. The patch grows slightly with the load: the
  // waves are longer by its cube root, so each is higher by that and slower by its square.
  CHECK(rolls(1, 0.003) > 0);
  CHECK(rolls(1, 0.006) == Approx(4 * rolls(1, 0.003)).epsilon(1e-3));
  CHECK(rolls(8, 0.003) == Approx(rolls(1, 0.003) / 2).epsilon(1e-3));
  // At 1 m/s the profile would lift it: independent of the speed, proportional to the load.
  CHECK(rolls(1, 2) == Approx(rolls(1, 1)).epsilon(1e-4));
  CHECK(rolls(2, 1) == Approx(2 * rolls(1, 1)).epsilon(1e-4));
}

TEST_CASE("The transition from sliding to rolling has no jump") {
  // A ball whose contact slips less and less: c_b goes from 0 to c_a.
  SlidingBench h(board(true));
  double slide = -1, roll = -1;
  for (int ms = 0; ms <= 400; ++ms) {
    const double slip = ms < 100 ? 1 : ms < 300 ? 1 - (ms - 100) / 200.0 : 0, speed = 0.2;
    h.bodies.push(published_pose(h.now_ms + 1, turn(0)), at_ms(static_cast<double>(h.now_ms + 1)));
    contact_t c = sliding({slip * speed, 0, 0}, 2, {1e-3 * ms * speed, 0, 0});
    c.tool = -1;
    c.rolling_velocity_m_s = to_vec3f(Vector3d((1 - slip / 2) * speed, 0, 0));
    const Scrape s = h.step(c).at(0);
    const double slides = static_cast<double>(s.slide), rolls = static_cast<double>(s.roll);
    if (ms == 0) CHECK(rolls == 0);
    if (ms == 400) {
      CHECK(slides == 0);
      CHECK(rolls > 0);
    }
    // Sliding follows a root, which is steepest where it ends: a hundredth of the whole path changes it by a
    // tenth. Rolling follows the square of the speed: its last hundredth changes it by 2 %; the gate adds at
    // most the opening over 20 um.
    if (ms > 1) {
      REQUIRE(std::abs(slides - slide) < 0.2 * 1e-3);
      REQUIRE(std::abs(rolls - roll) < 0.2 * 1e-3);
    }
    slide = slides, roll = rolls;
  }
}

TEST_CASE("Contradictory contacts give finite sound") {
  SlidingBench h(board(true));
  const double bad = GENERATE(1e30, -1e30, std::numeric_limits<double>::quiet_NaN());
  const int where = GENERATE(0, 1, 2, 3, 4);
  contact_t c = sliding({0, 0.1, 0}, 2, {0.005, 0.003, 0});
  c.tool = where == 4 ? -1 : 0;
  const auto value = static_cast<float>(bad);
  if (where == 0) c.sliding_velocity_m_s.y = value;
  if (where == 1) c.normal_force_N = value;
  if (where == 2) c.normal = {value, value, 0};
  if (where == 3) c.points[0].a_body_m.x = value;
  if (where == 4) c.rolling_velocity_m_s.x = value;
  auto scrapes = std::make_unique<Scrapes>(48000);
  auto voices = std::make_unique<Voices>(4, 48000, ring(Instructions::kSse2));
  for (int ms = 0; ms < 20; ++ms) {
    for (const Scrape& s : h.step(c)) scrapes->update(s);
    float stereo[96] = {};
    scrapes->render(0, 48, at_ms(static_cast<double>(h.now_ms))), scrapes->drive(*voices, 48);
    voices->render(stereo, 48);
    for (const float x : stereo) REQUIRE(std::abs(x) < 10);
  }
}

TEST_CASE("With many contacts the strongest are audible, and all are processed at the snapshot rate") {
  SlidingBench h(board(true));
  CHECK(h.slides.period_s() == 0);
  sync::Contacts many;
  for (int i = 0; i < 200; ++i) {
    many.push_back(sliding({0, 0.1, 0}, 0.1 + 0.01 * i, {0.005, 0.003, 0}));
    many.back().contact_id = i;
  }
  const auto all = h.slides.scrapes(many, sim_ms(501), at_ms(501), 0.001);
  REQUIRE(all.size() == Scrapes::kMax);
  for (const Scrape& s : all) CHECK(s.id >= 200 - Scrapes::kMax);
  CHECK(h.slides.period_s() == Approx(1 / 60.));
}
