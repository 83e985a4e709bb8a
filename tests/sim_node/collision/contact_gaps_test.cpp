// The contact tracker with contacts that have gaps and with impacts reported by the solver.
#include <catch2/catch.hpp>
#include <tactus/contact_event_t.hpp>

#include "sim_node/behaviour/solver.h"
#include "sim_node/contacts/contact_tracker.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

struct Watched {
  Settings settings;
  Ids ids{3};
  Solver solver;
  ContactTracker tracker;
  sync::SimTime now{};
  std::vector<contact_event_t> events;

  static Settings by_impulse(double h) {
    Settings s;
    s.solver = "impulse";
    s.detector = "auto";
    s.step_s = h;
    return s;
  }
  Watched(const WorldDef& w, double h)
      : settings(by_impulse(h)), solver(w, settings), tracker(surface_traits(w, settings), settings, ids) {}
  void step() {
    solver.step();
    const auto length = sync::from_seconds(settings.step_s);
    now += length;
    tracker.update(now, length, solver.bodies(), solver.contacts(), solver.solved(), events);
  }
  void run(double seconds) {
    for (int i = 0; i < std::lround(seconds / settings.step_s); ++i) step();
  }
  std::vector<contact_event_t> of_kind(int kind) const {
    std::vector<contact_event_t> out;
    for (const auto& e : events)
      if (e.kind == kind) out.push_back(e);
    return out;
  }
};

}  // namespace

TEST_CASE("A bounce within one step has begin, hit and end at its times, at 1 kHz and 60 Hz") {
  const double h = GENERATE(0.001, 1.0 / 60), e = GENERATE(0.5, 0.9);
  WorldDef w = empty_world();
  add_floor(w, 0.5, 1);
  const double r = 0.03, height = 0.7;
  add_ball(w, 0.2, r, {0, 0, r + height}, 0.5, e);
  Watched t(w, h);
  const double exact_s = std::sqrt(2 * height / kG), speed = kG * exact_s;
  t.run(exact_s + 0.1);
  REQUIRE(t.of_kind(contact_event_t::BEGIN).size() == 1);
  REQUIRE(t.of_kind(contact_event_t::HIT).size() == 1);
  REQUIRE(t.of_kind(contact_event_t::END).size() == 1);
  // Surfaces meet 10 um apart, which at this speed is 3 us early.
  for (const contact_event_t& event : t.events)
    CHECK(event.time_ns * 1e-9 == Approx(exact_s).margin(1.1e-5 / speed + 1e-7));
  const contact_event_t hit = t.of_kind(contact_event_t::HIT)[0];
  CHECK(hit.approach_speed_m_s == Approx(speed).epsilon(1e-4));
  CHECK(hit.effective_mass_kg == Approx(0.2).epsilon(1e-4));
  CHECK(hit.curvature_1_m == Approx(1 / r).epsilon(1e-4));
  CHECK(std::abs(hit.point_m.z) < 1e-4);
  CHECK(t.events[0].kind == contact_event_t::BEGIN);
  CHECK(t.events[1].kind == contact_event_t::HIT);
  CHECK(t.events[2].kind == contact_event_t::END);
  CHECK(t.tracker.live().empty());
}

TEST_CASE("A body without restitution hits once with its approach speed and stays in contact") {
  const double h = GENERATE(0.001, 1.0 / 60), speed = GENERATE(0.5, 20.0);
  WorldDef w = empty_world(0);
  add_floor(w);
  const int box = add_box(w, 0.3, {0.1, 0.08, 0.06}, at(0, 0, 0.5));
  w.bodies[static_cast<std::size_t>(box)].velocity_m_s = {0, 0, -speed};
  Watched t(w, h);
  t.run(0.47 / speed + 0.3);
  REQUIRE(t.events.size() == 2);
  CHECK(t.events[0].kind == contact_event_t::BEGIN);
  CHECK(t.events[1].kind == contact_event_t::HIT);
  for (const contact_event_t& event : t.events) {
    CHECK(event.time_ns * 1e-9 == Approx(0.47 / speed).margin(1.1e-5 / speed + 1e-7));
    CHECK(event.approach_speed_m_s == Approx(speed).epsilon(1e-4));
  }
  REQUIRE(t.tracker.live().size() == 1);
  CHECK(t.tracker.live()[0].touching);
}

TEST_CASE("A body that is only near another has no contact") {
  const double h = GENERATE(0.001, 1.0 / 60);
  WorldDef w = empty_world(0);
  add_floor(w);
  const int ball = add_ball(w, 0.2, 0.03, {-0.3, 0, 0.03 + 1e-4});
  add_box(w, 0.2, {0.1, 0.1, 0.1}, at(0, 0.0801 + 0.001, 0.3));
  w.bodies[static_cast<std::size_t>(ball)].velocity_m_s = {1, 0, 0};
  Watched t(w, h);
  t.run(0.5);
  CHECK_FALSE(t.solver.contacts().empty());
  CHECK(t.events.empty());
  CHECK(t.tracker.live().empty());
}

TEST_CASE("A body that rests, rolls or slides for ten seconds begins its contact once") {
  const double h = GENERATE(0.001, 1.0 / 60);
  WorldDef w = empty_world();
  add_floor(w, 0.3);
  add_box(w, 0.5, {0.1, 0.1, 0.1}, at(0, 0, 0.05), 0.3);
  const int ball = add_ball(w, 0.5, 0.05, {0, 1, 0.05}, 0.3);
  const int block = add_box(w, 0.5, {0.1, 0.1, 0.04}, at(0, -1, 0.02), 0.0);
  add_box(w, 0.2, {0.06, 0.06, 0.06}, at(0, 0, 0.13) * Eigen::AngleAxisd(0.4, Vector3d::UnitZ()), 0.3);
  w.bodies[static_cast<std::size_t>(ball)].velocity_m_s = {0.4, 0, 0};
  w.bodies[static_cast<std::size_t>(block)].velocity_m_s = {0.3, 0, 0};
  Watched t(w, h);
  t.run(10);
  CHECK(t.of_kind(contact_event_t::BEGIN).size() == 4);
  CHECK(t.of_kind(contact_event_t::HIT).empty());
  CHECK(t.of_kind(contact_event_t::END).empty());
  CHECK(t.tracker.live().size() == 4);
}

TEST_CASE("An impact within the step is a contact for any final gap, a gap alone is not") {
  WorldDef w = empty_world(0);
  add_floor(w);
  add_ball(w, 0.1, 0.02, {0, 0, 0.02});
  Settings settings;
  Ids ids(1);
  ContactTracker tracker(surface_traits(w, settings), settings, ids);
  std::vector<contact_event_t> events;
  std::vector<BodyMotion> bodies(2);
  bodies[1].inverse_mass_1_kg = 10;
  Manifold m;
  m.shape_a = 0, m.shape_b = 1, m.body_a = 0, m.body_b = 1, m.count = 1;
  const auto update = [&](int tick, double length_s, double gap_m, const Manifold* solved) {
    bodies[1].position_m = bodies[1].centre_m = {0, 0, 0.02 + gap_m};
    m.points[0].depth_m = -gap_m;
    m.points[0].point_m = {0, 0, gap_m / 2};
    tracker.update(sync::sim_time(tick * std::int64_t{1'000'000}), sync::from_seconds(length_s), bodies, {&m, 1},
                   solved ? std::span<const Manifold>(solved, 1) : std::span<const Manifold>(), events);
  };
  update(0, 0.001, 1e-3, nullptr);
  update(1, 0.001, 1e-4, nullptr);
  CHECK(events.empty());
  SECTION("begin, hit and end have the times that the solver reports") {
    Manifold met = m;
    met.impact.count = 2;
    met.impact.first_s = 0.002, met.impact.last_s = 0.011, met.impact.speed_m_s = 3,
    met.impact.effective_mass_kg = 0.1;
    met.points[0].normal_force_N = 10;
    update(17, 0.016, 0.02, &met);
    REQUIRE(events.size() == 3);
    CHECK(events[0].kind == contact_event_t::BEGIN);
    CHECK(events[0].time_ns == 3'000'000);
    CHECK(events[1].kind == contact_event_t::HIT);
    CHECK(events[1].time_ns == 3'000'000);
    CHECK(events[1].approach_speed_m_s == Approx(3));
    CHECK(events[2].kind == contact_event_t::END);
    CHECK(events[2].time_ns == 12'000'000);
    CHECK(tracker.live().empty());
  }
  SECTION("a gap below the residual remains a contact until it clearly opens") {
    update(2, 0.001, 8e-6, nullptr);
    CHECK(events.size() == 1);
    for (int tick = 3; tick < 60; ++tick) update(tick, 0.001, tick % 2 ? 4e-5 : 0, nullptr);
    CHECK(events.size() == 1);
    for (int tick = 60; tick < 70; ++tick) update(tick, 0.001, 1e-4, nullptr);
    CHECK(events.size() == 2);
    CHECK(events.back().kind == contact_event_t::END);
  }
}
