#include <catch2/catch.hpp>
#include <cmath>
#include <tactus/contact_event_t.hpp>

#include "sim_node/world/simulation.h"
#include "tests/sim_node/support/dual_bench.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

TEST_CASE("A body out of reach of all tools follows the parabola in visual steps") {
  WorldDef w = empty_world();
  const int ball = add_ball(w, 1, 0.05, {0, 0, 10});
  Dual d(w);
  for (int i = 0; i < 200; ++i) {
    d.tick();
    CHECK_FALSE(d.groups.is_haptic(ball));
    const VisualStep& step = *d.groups.step();
    const double t = sync::to_seconds(d.groups.step_ends().time_since_epoch());
    CHECK(step.end[static_cast<std::size_t>(ball)].centre_m.z() == Approx(10 - kG / 2 * t * t).margin(1e-9));
    const auto ticks = step.task.length / sync::Nanoseconds(1'000'000);
    CHECK((ticks == 16 || ticks == 17));
  }
}

TEST_CASE("A ball that falls past the tool changes groups twice and stays on its parabola") {
  WorldDef w = empty_world();
  const int ball = add_ball(w, 1, 0.05, {0, 0, 2});
  // Beside the trajectory of the ball, near enough for contact to be possible.
  Dual d(w, dual_settings(), {0.063, 0, 1.0});
  bool was = false, is = false;
  for (int i = 0; i < 620; ++i) {
    d.tick();
    is = d.groups.is_haptic(ball);
    was = was || is;
    if (is) {
      const double t = 0.001 * static_cast<double>(d.ticks);
      CHECK(d.body(ball).centre_m.z() == Approx(2 - kG / 2 * t * t).margin(1e-9));
    }
  }
  CHECK(was);
  CHECK_FALSE(is);
  const double t = sync::to_seconds(d.groups.step_ends().time_since_epoch());
  CHECK(d.groups.step()->end[static_cast<std::size_t>(ball)].centre_m.z() ==
        Approx(2 - kG / 2 * t * t).margin(1e-9));
}

TEST_CASE("A bounce within one visual step has begin, hit and end at the right times") {
  WorldDef w = empty_world();
  add_floor(w, 0.5, 1);
  add_ball(w, 1, 0.05, {0, 0, 0.55}, 0.5, 1);
  Dual d(w);
  d.run(500);
  REQUIRE(d.count(contact_event_t::BEGIN) == 1);
  CHECK(d.count(contact_event_t::HIT) == 1);
  CHECK(d.count(contact_event_t::END) == 1);
  const double fall = std::sqrt(2 * 0.5 / kG);
  for (const contact_event_t& e : d.events)
    CHECK(1e-9 * static_cast<double>(e.time_ns) == Approx(fall).margin(2e-4));
  CHECK(d.events[1].approach_speed_m_s == Approx(kG * fall).epsilon(0.005));
}

TEST_CASE("An event of a visual step is published in the tick in which it happens") {
  WorldDef w = empty_world();
  add_floor(w, 0.5, 0.8);
  for (int i = 0; i < 8; ++i) add_ball(w, 0.2, 0.05, {0.3 * i, 0, 0.5 - 0.004 * i}, 0.5, 0.8);
  Dual d(w);
  std::size_t seen = 0;
  for (int i = 0; i < 1500; ++i) {
    d.tick();
    for (; seen < d.events.size(); ++seen) {
      CHECK(d.events[seen].time_ns <= d.ticks * 1'000'000);
      CHECK(d.events[seen].time_ns > (d.ticks - 1) * 1'000'000);
    }
  }
  CHECK(seen > 30);
}

TEST_CASE("Bodies at rest change groups without a begin or an end event") {
  WorldDef w = empty_world();
  add_floor(w);
  const int box = add_box(w, 0.5, {0.1, 0.1, 0.1}, at(0, 0, 0.05));
  const int upper = add_box(w, 0.5, {0.1, 0.1, 0.1}, at(0, 0, 0.15));
  Dual d(w);
  d.run(300);
  const std::size_t before = d.events.size();
  for (int round = 0; round < 5; ++round) {
    // The tool comes near the lower box only; the box on top of it enters too.
    d.tools[0].centre_m = {0.062, 0, 0.03};
    d.run(40);
    CHECK(d.groups.is_haptic(box));
    CHECK(d.groups.is_haptic(upper));
    d.tools[0].centre_m = {0, 0, 50};
    d.run(120);
    CHECK_FALSE(d.groups.is_haptic(box));
    CHECK_FALSE(d.groups.is_haptic(upper));
  }
  for (std::size_t i = before; i < d.events.size(); ++i)
    UNSCOPED_INFO("kind " << int(d.events[i].kind) << " at " << d.events[i].time_ns);
  CHECK(d.events.size() == before);
  CHECK(d.body(upper).centre_m.z() == Approx(0.15).margin(0.001));
}

TEST_CASE("The same ticks give a bit-identical world for any motion of the tool") {
  const auto run = [] {
    WorldDef w = empty_world();
    add_floor(w, 0.5, 0.3);
    for (int i = 0; i < 20; ++i)
      add_ball(w, 0.2, 0.03, {0.08 * (i % 5), 0.08 * (i / 5), 0.1 + 0.03 * i}, 0.4, 0.5);
    Dual d(w);
    double sum = 0;
    for (int i = 0; i < 800; ++i) {
      const double t = 0.001 * i;
      d.tools[0].centre_m = {0.15 + 0.2 * std::sin(5 * t), 0.1 + 0.2 * std::cos(7 * t),
                             0.05 + 0.05 * std::sin(11 * t)};
      d.tools[0].velocity_m_s = {std::cos(5 * t), -1.4 * std::sin(7 * t), 0.55 * std::cos(11 * t)};
      d.tick();
      for (const BodyMotion& m : d.groups.motions()) sum += m.centre_m.sum() * (1 + 0.001 * i);
    }
    return std::pair(sum, d.events.size());
  };
  CHECK(run() == run());
}

TEST_CASE("A restored state continues bit-identically, independent of the steps since") {
  WorldDef w = empty_world();
  add_floor(w, 0.5, 0.3);
  for (int i = 0; i < 12; ++i) add_ball(w, 0.2, 0.03, {0.08 * (i % 4), 0.08 * (i / 4), 0.1 + 0.03 * i}, 0.4, 0.5);
  Dual d(w);
  const auto move = [&](int i) {
    const double t = 0.001 * i;
    d.tools[0].centre_m = {0.15 + 0.2 * std::sin(5 * t), 0.1 + 0.2 * std::cos(7 * t),
                           0.05 + 0.05 * std::sin(11 * t)};
    d.tools[0].velocity_m_s = {std::cos(5 * t), -1.4 * std::sin(7 * t), 0.55 * std::cos(11 * t)};
  };
  for (int i = 0; i < 333; ++i) move(i), d.tick();
  StateArchive saved, ids;
  d.groups.archive(saved);
  d.ids.archive(ids);
  const auto run_again = [&] {
    d.events.clear();
    double sum = 0;
    for (int i = 333; i < 700; ++i) {
      move(i);
      d.tick();
      for (const BodyMotion& m : d.groups.motions()) sum += m.centre_m.sum() * (1 + 0.001 * i);
    }
    std::int64_t numbers = 0;
    for (const contact_event_t& e : d.events) numbers += e.event_id ^ e.time_ns;
    return std::tuple(sum, d.events.size(), numbers);
  };
  const auto first = run_again();
  StateArchive back{std::span<const std::uint8_t>(saved.bytes())},
      back_ids{std::span<const std::uint8_t>(ids.bytes())};
  d.ids.archive(back_ids);
  d.groups.archive(back);
  CHECK(back.at_end());
  d.ticks = 333;
  CHECK(run_again() == first);
}

TEST_CASE("The solver setting selects evaluation of the springs near a tool at the start or end of a step") {
  // The ball sinks into its spring. Evaluated at the start of the step, the first force belongs to the previous
  // position.
  WorldDef w = empty_world();
  add_floor(w);
  const double mass = 0.1;
  const int ball = add_ball(w, mass, 0.03, {0, 0, 0.0305});
  w.bodies[static_cast<std::size_t>(ball)].velocity_m_s = {0, 0, -0.02};
  const auto lowest = [&](const std::string& groups, const std::string& solver) {
    Settings s = dual_settings();
    s.groups = groups;
    s.solver = solver;
    s.penalty_damping_Ns_m = 0;
    double least = 1;
    if (groups == "single") {
      Simulation one(w, s);
      one.start(1);
      for (int i = 0; i < 60; ++i) {
        one.step({});
        least = std::min(least, one.bodies()[static_cast<std::size_t>(ball)].centre_m.z());
      }
      return least;
    }
    Dual d(w, s, {0.045, 0, 0.03});
    for (int i = 0; i < 60; ++i) {
      d.tick();
      REQUIRE(d.groups.is_haptic(ball));
      least = std::min(least, d.body(ball).centre_m.z());
    }
    return least;
  };
  CHECK(lowest("dual", "impulse") == Approx(lowest("single", "penalty")).margin(1e-12));
  CHECK(lowest("dual", "penalty_explicit") == Approx(lowest("single", "penalty_explicit")).margin(1e-12));
  CHECK(std::abs(lowest("dual", "impulse") - lowest("dual", "penalty_explicit")) > 1e-6);
}
