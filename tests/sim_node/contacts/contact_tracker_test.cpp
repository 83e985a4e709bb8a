#include "sim_node/contacts/contact_tracker.h"

#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <set>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>

#include "sim_node/behaviour/solver.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

// A world with a tracker, stepped together.
struct Tracked {
  Settings settings;
  Ids ids{3};
  Solver solver;
  ContactTracker tracker;
  std::int64_t step = 0;
  std::vector<contact_event_t> events;

  explicit Tracked(const WorldDef& w, Settings s = {})
      : settings(s), solver(w, settings), tracker(surface_traits(w, settings), settings, ids) {}
  sync::SimTime now() const { return sync::sim_time(step * std::int64_t{1'000'000}); }
  void run(double seconds) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds / kStep)); ++i) {
      solver.step();
      ++step;
      tracker.update(now(), sync::from_seconds(settings.step_s), solver.bodies(), solver.contacts(), solver.solved(), events);
    }
  }
  std::vector<contact_event_t> of_kind(int kind) const {
    std::vector<contact_event_t> out;
    for (const auto& e : events)
      if (e.kind == kind) out.push_back(e);
    return out;
  }
};

// Impulses with contacts that have gaps, or ODE with overlapping contacts.
Settings by(const char* solver) {
  Settings s;
  s.solver = solver;
  return s;
}

// With gaps, surfaces meet at this distance, m.
constexpr double kMeet_m = 1e-5;

contact_t described(const Tracked& t, std::size_t i) {
  contact_t c{};
  t.tracker.describe(t.tracker.live()[i], t.solver.bodies(), c);
  return c;
}

}  // namespace

TEST_CASE("A falling ball begins and hits once at the time of the parabola") {
  const auto solver = GENERATE("impulse", "quick");
  for (const double height : {0.05, 0.3, 1.0, 2.37}) {
    WorldDef w = empty_world();
    add_floor(w);
    const double r = 0.03;
    add_ball(w, 0.2, r, {0, 0, r + height});
    Tracked t(w, by(solver));
    const double exact_s = std::sqrt(2 * height / kG), speed = std::sqrt(2 * kG * height);
    t.run(exact_s + 0.5);
    INFO("height " << height);
    REQUIRE(t.of_kind(contact_event_t::BEGIN).size() == 1);
    REQUIRE(t.of_kind(contact_event_t::HIT).size() == 1);
    CHECK(t.of_kind(contact_event_t::END).empty());
    const contact_event_t hit = t.of_kind(contact_event_t::HIT)[0];
    // The positions at the ends of the steps lie on the parabola. The tracker extrapolates from the overlap with the
    // speed of the middle of the step instead of the curve: the error is at most g h^2 / (8 v).
    CHECK(std::abs(hit.time_ns * 1e-9 - exact_s) < kG * kStep * kStep / (8 * speed) + 1.01 * kMeet_m / speed + 2e-9);
    CHECK(hit.approach_speed_m_s == Approx(speed).margin(kG * kStep));
    CHECK(hit.effective_mass_kg == Approx(0.2).epsilon(1e-6));
    CHECK(hit.curvature_1_m == Approx(1 / r).epsilon(1e-5));
    CHECK(hit.normal.z == Approx(1));  // from the floor, which is body a, to the ball
    CHECK(hit.body_a == 0);
    // Within the overlap at the end of the step.
    CHECK(hit.point_m.z == Approx(0).margin(speed * kStep));
    CHECK(t.of_kind(contact_event_t::BEGIN)[0].contact_id == hit.contact_id);
    CHECK(t.of_kind(contact_event_t::BEGIN)[0].time_ns == hit.time_ns);
  }
}

TEST_CASE("The hits of a bouncing ball follow its restitution") {
  const auto solver = GENERATE("impulse", "quick");
  WorldDef w = empty_world();
  const double r = 0.02, height = 0.4, e = 0.7;
  add_floor(w, 0.5, 1);
  add_ball(w, 0.1, r, {0, 0, r + height}, 0.5, e);
  Tracked t(w, by(solver));
  t.run(3);
  const auto hits = t.of_kind(contact_event_t::HIT);
  // Hits at t0, t0 + 2 e t0, ..., with speeds v0 e^n, until they are below the hit threshold.
  const double t0 = std::sqrt(2 * height / kG), v0 = kG * t0;
  double time = t0, speed = v0;
  std::size_t n = 0;
  for (; speed > 1.3 * t.settings.hit_speed_m_s; ++n) {
    REQUIRE(hits.size() > n);
    INFO("bounce " << n);
    // Each bounce starts at the end of its step, up to a step late, from within the surface layer, and with up to a
    // step of gravity too much speed. The errors add up.
    CHECK(hits[n].time_ns * 1e-9 == Approx(time).margin(1e-6 + 1.01 * kMeet_m / speed + 0.0035 * static_cast<double>(n)));
    CHECK(hits[n].approach_speed_m_s == Approx(speed).margin(2.5 * kG * kStep));
    speed *= e;
    time += 2 * speed / kG;
  }
  CHECK(n >= 8);
  CHECK(hits.size() <= n + 3);
  // It comes to rest in one lasting contact.
  REQUIRE(t.tracker.live().size() == 1);
  CHECK(t.of_kind(contact_event_t::BEGIN).size() == t.of_kind(contact_event_t::END).size() + 1);
}

TEST_CASE("The contacts of a resting stack begin once and never hit") {
  const auto solver = GENERATE("impulse", "quick");
  WorldDef w = empty_world();
  add_floor(w);
  for (int i = 0; i < 4; ++i) add_box(w, 0.5, {0.1, 0.1, 0.1}, at(0, 0, 0.05 + 0.1 * i));
  Tracked t(w, by(solver));
  t.run(3);
  CHECK(t.of_kind(contact_event_t::BEGIN).size() == 4);
  CHECK(t.of_kind(contact_event_t::HIT).empty());
  CHECK(t.of_kind(contact_event_t::END).empty());
  REQUIRE(t.tracker.live().size() == 4);
  const contact_t lowest = described(t, 0);
  CHECK(lowest.kind == contact_t::SURFACE);
  CHECK(lowest.area_m2 == Approx(0.01).epsilon(0.05));
  CHECK(lowest.point_count == 4);
  CHECK(lowest.normal_force_N == Approx(4 * 0.5 * kG).epsilon(0.05));
  CHECK(lowest.impulse_N_s == Approx(4 * 0.5 * kG * 3).epsilon(0.02));
}

TEST_CASE("A box that rocks onto its other edge hits again in the same contact") {
  const auto solver = GENERATE("impulse", "quick");
  WorldDef w = empty_world();
  add_floor(w, 1);
  // Released from a tilt of 4 degrees on one edge: it rotates about the edge until the other edge hits.
  const double tilt = 0.07, half = 0.1;
  const double rise = half * std::sin(tilt) + 0.02 * std::cos(tilt);
  add_box(w, 1, {2 * half, 0.1, 0.04}, at(0, 0, rise) * Eigen::AngleAxisd(tilt, Vector3d::UnitY()), 1);
  Tracked t(w, by(solver));
  t.run(0.5);
  REQUIRE(t.of_kind(contact_event_t::BEGIN).size() == 1);
  REQUIRE_FALSE(t.of_kind(contact_event_t::HIT).empty());
  const contact_event_t hit = t.of_kind(contact_event_t::HIT)[0];
  CHECK(hit.time_ns > t.of_kind(contact_event_t::BEGIN)[0].time_ns + 20'000'000);
  CHECK(hit.approach_speed_m_s > 0.2);
  // Speed from energy: m g h = I w^2 / 2 about the edge, at the lever arm of the full width.
  const double inertia = 1.0 / 12 * (0.04 + 0.0016) + (half * half + 0.0004);
  const double energy_speed = 2 * half * std::sqrt(2 * kG * (rise - 0.02) / inertia);
  CHECK(hit.approach_speed_m_s == Approx(energy_speed).epsilon(0.05));
}

TEST_CASE("Sliding and rolling are distinguished") {
  const auto solver = GENERATE("impulse", "quick");
  WorldDef w = empty_world();
  add_floor(w, 0.3);
  const double r = 0.05;
  const int ball = add_ball(w, 0.5, r, {0, 0, r}, 0.3);
  w.bodies[static_cast<std::size_t>(ball)].velocity_m_s = {1, 0, 0};
  Tracked t(w, by(solver));
  t.run(0.02);
  contact_t c = described(t, 0);
  // Sliding first: deceleration mu g, angular acceleration mu m g r / I.
  CHECK(c.sliding_velocity_m_s.x == Approx(1 - 0.3 * kG * 0.02 * 3.5).epsilon(0.03));
  t.run(0.5);
  c = described(t, 0);
  // Then rolling with 5/7 of the speed, for any friction.
  CHECK(std::abs(c.sliding_velocity_m_s.x) < 0.01);
  CHECK(t.solver.bodies()[static_cast<std::size_t>(ball)].velocity_m_s.x() == Approx(5.0 / 7).epsilon(0.01));
  CHECK(c.rolling_velocity_m_s.x == Approx(5.0 / 7).epsilon(0.03));
  CHECK(c.kind == contact_t::POINT);
}

TEST_CASE("Every contact of tumbling bodies begins once, then hits, and ends at most once") {
  const auto solver = GENERATE("impulse", "quick");
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  WorldDef w = empty_world();
  add_floor(w, 0.4, 0.6);
  for (int i = 0; i < 25; ++i) {
    const Eigen::Isometry3d pose = at(0.15 * u(random), 0.15 * u(random), 0.3 + 0.12 * i) *
                                   Eigen::AngleAxisd(3 * u(random), Vector3d(u(random), u(random), u(random)).normalized());
    if (i % 3 == 0) add_ball(w, 0.1, 0.04, pose.translation(), 0.4, 0.8);
    if (i % 3 == 1) add_box(w, 0.2, {0.08, 0.1, 0.06}, pose, 0.4, 0.5);
    if (i % 3 == 2) {
      const int body = add_body(w, "rod", 0.15, box_inertia(0.15, {0.04, 0.04, 0.12}), pose);
      add_shape(w, body, i % 2 ? ShapeKind::kCapsule : ShapeKind::kCylinder, {0.03, 0, 0.08}, 0.4, 0.5);
    }
  }
  Tracked t(w, by(solver));
  t.run(4);
  std::set<std::int64_t> event_ids;
  struct ContactLifetime {
    std::int64_t begun = -1, ended = -1, last = -1;
    std::pair<int, int> bodies;
  };
  std::map<std::int64_t, ContactLifetime> lifetimes;
  for (const contact_event_t& e : t.events) {
    CHECK(event_ids.insert(e.event_id).second);
    CHECK(e.body_a < e.body_b);
    CHECK(std::isfinite(e.effective_mass_kg));
    CHECK(e.effective_mass_kg > 0);
    CHECK(e.curvature_1_m >= 0);
    ContactLifetime& lifetime = lifetimes[e.contact_id];
    if (e.kind == contact_event_t::BEGIN) {
      CHECK(lifetime.begun < 0);
      lifetime.begun = e.time_ns;
      lifetime.bodies = {e.body_a, e.body_b};
    }
    CHECK(lifetime.begun >= 0);
    CHECK(lifetime.ended < 0);
    CHECK(e.time_ns >= lifetime.last);
    CHECK(lifetime.bodies == std::pair<int, int>(e.body_a, e.body_b));
    if (e.kind == contact_event_t::HIT) CHECK(e.approach_speed_m_s > t.settings.hit_speed_m_s);
    if (e.kind == contact_event_t::END) lifetime.ended = e.time_ns;
    lifetime.last = e.time_ns;
  }
  CHECK(t.of_kind(contact_event_t::HIT).size() > 50);
  // The live contacts are those that have begun and not ended, once each, and one per pair of shapes.
  std::size_t open = 0;
  for (const auto& [id, lifetime] : lifetimes) open += lifetime.ended < 0;
  CHECK(open == t.tracker.live().size());
  std::set<std::pair<int, int>> pairs;
  for (const LiveContact& c : t.tracker.live()) {
    CHECK(lifetimes.at(c.id).ended < 0);
    CHECK(pairs.insert({c.manifold.shape_a, c.manifold.shape_b}).second);
  }
}

TEST_CASE("Surfaces that oscillate within the hysteresis keep one contact") {
  WorldDef w = empty_world(0);
  add_floor(w);
  add_ball(w, 0.1, 0.02, {0, 0, 0.02});
  Settings settings;
  Ids ids(1);
  ContactTracker tracker(surface_traits(w, settings), settings, ids);
  std::vector<contact_event_t> events;
  std::vector<BodyMotion> bodies(2);
  bodies[1].inverse_mass_1_kg = 10;
  Manifold touch;
  touch.shape_a = 0, touch.shape_b = 1, touch.body_a = 0, touch.body_b = 1, touch.count = 1;
  const auto step = [&](int tick, double height_m, double speed_m_s) {
    bodies[1].position_m = bodies[1].centre_m = {0, 0, 0.02 + height_m};
    bodies[1].velocity_m_s = {0, 0, speed_m_s};
    touch.points[0].depth_m = -height_m;
    const std::span<const Manifold> now(&touch, height_m <= 0 ? 1 : 0);
    tracker.update(sync::sim_time(tick * std::int64_t{1'000'000}), sync::Nanoseconds(1'000'000), bodies, now, {}, events);
  };
  // Up and down by 0.2 mm, three ticks each: below the gap and the time that end a contact.
  for (int i = 0; i < 60; ++i) step(i, i % 6 < 3 ? -1e-5 : 2e-4, i % 6 < 3 ? -0.01 : 0.01);
  REQUIRE(events.size() == 1);
  CHECK(events[0].kind == contact_event_t::BEGIN);
  SECTION("a fast return is a hit, limited by the minimum interval") {
    for (int i = 60; i < 120; ++i) step(i, i % 2 ? -1e-5 : 1e-4, i % 2 ? -0.2 : 0.2);
    CHECK(events.size() >= 9);
    for (std::size_t i = 2; i < events.size(); ++i) {
      CHECK(events[i].kind == contact_event_t::HIT);
      CHECK(events[i].time_ns - events[i - 1].time_ns >= 4'900'000);
    }
  }
  SECTION("a gap beyond the limit ends the contact at the time when it opened") {
    step(60, -1e-5, 0.0);
    step(61, 1e-3, 1.0);
    REQUIRE(events.size() == 2);
    CHECK(events[1].kind == contact_event_t::END);
    CHECK(events[1].time_ns == Approx(60'000'000).margin(20'000));
    CHECK(tracker.live().empty());
  }
}

TEST_CASE("Each impact of a body that rattles is a hit, limited by the minimum interval") {
  WorldDef w = empty_world(0);
  add_floor(w);
  add_ball(w, 0.1, 0.02, {0, 0, 0.02});
  Settings settings;
  Ids ids(1);
  ContactTracker tracker(surface_traits(w, settings), settings, ids);
  std::vector<contact_event_t> events;
  std::vector<BodyMotion> bodies(2);
  bodies[1].inverse_mass_1_kg = 10;
  bodies[1].position_m = bodies[1].centre_m = {0, 0, 0.02};
  Manifold touch;
  touch.shape_a = 0, touch.shape_b = 1, touch.body_a = 0, touch.body_b = 1, touch.count = 1;
  Manifold struck = touch;
  struck.impact.count = 1;
  struck.impact.effective_mass_kg = 0.1;
  struck.points[0].normal_force_N = 1;
  // An impact in every step, at the end of which the surfaces touch.
  for (int i = 1; i <= 60; ++i) {
    struck.impact.first_s = struck.impact.last_s = 0.0005;
    struck.impact.speed_m_s = 0.2 + 0.001 * i;
    tracker.update(sync::sim_time(i * std::int64_t{1'000'000}), sync::Nanoseconds(1'000'000), bodies, {&touch, 1}, {&struck, 1}, events);
  }
  REQUIRE(events.size() == 1 + 60 / 5);
  CHECK(events[0].kind == contact_event_t::BEGIN);
  for (std::size_t i = 1; i < events.size(); ++i) {
    CHECK(events[i].kind == contact_event_t::HIT);
    CHECK(events[i].time_ns == static_cast<std::int64_t>(i - 1) * 5'000'000 + 500'000);
    CHECK(events[i].approach_speed_m_s == Approx(0.201 + 0.005 * static_cast<double>(i - 1)));
  }
}

TEST_CASE("A ball that falls 300 km from the origin hits at its exact place") {
  WorldDef w = empty_world();
  add_floor(w);
  const Vector3d above(3e5 + 0.0123, -2e5 - 0.0321, 0.08);
  add_ball(w, 0.2, 0.03, above);
  Tracked t(w, by("impulse"));
  t.run(0.3);
  REQUIRE(t.of_kind(contact_event_t::HIT).size() == 1);
  const contact_event_t hit = t.of_kind(contact_event_t::HIT)[0];
  // Tens of steps, each of which rounds to 6e-11 m.
  CHECK(hit.point_m.x == Approx(above.x()).margin(1e-7));
  CHECK(hit.point_m.y == Approx(above.y()).margin(1e-7));
}
