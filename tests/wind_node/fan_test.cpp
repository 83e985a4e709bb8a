#include "tests/wind_node/fan.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/wind_node/air.h"

using namespace tactus;
using namespace tactus::sync;
using Eigen::Vector3d;

namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kBegin = 1'000 * kMs;  // of the world, on the host's clock

HostTime host(std::int64_t ms) { return host_time(kBegin + ms * kMs); }

// One ball of 10 cm, and the head at the origin.
scene_t ball() {
  scene_t s{};
  s.body_count = 1;
  s.bodies.resize(1);
  s.shape_count = 1;
  s.shapes.resize(1);
  s.shapes[0].body = 0;
  s.shapes[0].kind = shape_def_t::SPHERE;
  s.shapes[0].size_m = {0.1, 0, 0};
  return s;
}

template <class Message>
Message stamped(std::int64_t ms) {
  Message m{};
  m.header.sim_time_ns = ms * kMs;
  m.header.publish_time_ns = kBegin + ms * kMs;
  m.header.run_id = m.header.incarnation = 1;
  m.clock = {ms * kMs, kBegin + ms * kMs, 1};
  m.pages = 1;
  return m;
}

world_state_t world(std::int64_t ms, double x_m, double speed_m_s) {
  auto m = stamped<world_state_t>(ms);
  m.count = 1;
  m.bodies.resize(1);
  m.bodies[0].position_m = {x_m, 0, 0};
  m.bodies[0].orientation.w = 1;
  m.bodies[0].velocity_m_s.x = static_cast<float>(speed_m_s);
  return m;
}

contact_events_t hit(std::int64_t ms, std::int64_t at_ms, std::int64_t id = 7) {
  auto m = stamped<contact_events_t>(ms);
  m.count = 1;
  m.events.resize(1);
  m.events[0].event_id = id;
  m.events[0].kind = contact_event_t::HIT;
  m.events[0].time_ns = at_ms * kMs;
  m.events[0].approach_speed_m_s = 1;
  return m;
}

HostTime after(std::int64_t, HostTime happened) { return happened + Nanoseconds(30 * kMs); }

}  // namespace

TEST_CASE(
    "Air moves with the sphere at its front, against it at its side, and falls with the cube of the distance") {
  const Vector3d v(2, 0, 0);
  CHECK((wind::air_velocity_m_s({0.1, 0, 0}, Vector3d::Zero(), 0.1, v) - v).norm() < 1e-12);
  CHECK((wind::air_velocity_m_s({0, 0.1, 0}, Vector3d::Zero(), 0.1, v) + v / 2).norm() < 1e-12);
  const double near = wind::air_velocity_m_s({0.2, 0.1, 0.3}, Vector3d::Zero(), 0.1, v).norm();
  CHECK(wind::air_velocity_m_s({0.4, 0.2, 0.6}, Vector3d::Zero(), 0.1, v).norm() == Approx(near / 8));
  CHECK(wind::air_velocity_m_s({0, 0, 0}, Vector3d::Zero(), 0.1, v).norm() == 0);
}

TEST_CASE("The sphere that stands for a body has its volume") {
  shape_def_t shape{};
  shape.size_m = {0.3, 0.2, 0.7};
  const double volume = [&] {
    const std::map<int, double> known{{shape_def_t::BOX, 0.3 * 0.2 * 0.7},
                                      {shape_def_t::SPHERE, 4.0 / 3 * M_PI * 0.027},
                                      {shape_def_t::CYLINDER, M_PI * 0.09 * 0.7},
                                      {shape_def_t::CAPSULE, M_PI * 0.09 * 0.7 + 4.0 / 3 * M_PI * 0.027}};
    shape.kind = static_cast<std::int8_t>(GENERATE(0, 1, 2, 3));
    return known.at(shape.kind);
  }();
  CHECK(4.0 / 3 * M_PI * std::pow(wind::equivalent_radius_m(shape, 9), 3) == Approx(volume));
  shape.kind = shape_def_t::MESH;
  CHECK(wind::equivalent_radius_m(shape, 9) == 9);
}

TEST_CASE(
    "The fan blows what the ball moves of the air, as it was the delay ago, and no more when the world is lost") {
  wind::Fan fan({}, ball(), 1);
  for (int ms = 0; ms <= 100; ms += 10) {
    fan.push(world(ms, 0.3 + 0.001 * ms, 1), host(ms));
    fan.push(hit(ms, 5000, 1), host(ms));  // of the future: refused
  }
  const auto wind_at = [](double x_m) { return std::pow(0.1 / x_m, 3); };
  CHECK(fan.step(host(100), {}, 0, after).wind_m_s == Approx(wind_at(0.4)));
  CHECK(fan.step(host(100), Nanoseconds(50 * kMs), 0, after).wind_m_s == Approx(wind_at(0.35)).epsilon(1e-6));
  CHECK(fan.step(host(1000), {}, 0, after).wind_m_s == 0);
}

TEST_CASE("Every hit is a gust in the first tick that its time has come in, once, and reported so") {
  wind::Fan fan({}, ball(), 1);
  std::vector<presentation_t> reports;
  std::map<int, double> gust;
  for (int ms = 0; ms < 200; ms += 20) {
    // Repeated for 50 ms.
    if (ms >= 20 && ms <= 60) fan.push(hit(ms, 13), host(ms));
    gust[ms] = fan.step(host(ms), {}, 0, after).gust;
    reports.insert(reports.end(), fan.reports().begin(), fan.reports().end());
  }
  REQUIRE(reports.size() == 1);
  CHECK(reports[0].event_id == 7);
  CHECK(reports[0].outcome == presentation_t::PRESENTED);
  CHECK(reports[0].scheduled_ns == to_ns(host(43)));
  CHECK(reports[0].presented_ns == to_ns(host(60)));
  CHECK(gust.at(40) == 0);
  CHECK(gust.at(60) == Approx(0.5));  // 1 m/s of 2
  CHECK(gust.at(80) == Approx(0.5 * std::exp(-0.020 / 0.15)));
}

TEST_CASE("A gust that comes late is called so, and one that comes too late is dropped") {
  wind::Fan fan({}, ball(), 1);
  fan.push(hit(900, 700, 1), host(900));
  fan.step(host(900), {}, 0, after);
  REQUIRE(fan.reports().size() == 1);
  CHECK(fan.reports()[0].outcome == presentation_t::LATE);
  fan.push(hit(2000, 800, 2), host(2000));
  CHECK(fan.step(host(2000), {}, 0, after).gust < 0.001);
  REQUIRE(fan.reports().size() == 1);
  CHECK(fan.reports()[0].outcome == presentation_t::DROPPED_LATE);
  CHECK(fan.reports()[0].presented_ns == -1);
}

TEST_CASE("A fan that is made slow follows with its time constant") {
  wind::Fan fan({}, ball(), 1);
  for (int ms = 0; ms <= 100; ms += 10) fan.push(world(ms, 0.2, 0.8), host(ms));
  CHECK(fan.step(host(0), {}, 0.02, after).share == 0);
  CHECK(fan.step(host(20), {}, 0.02, after).share == Approx((1 - std::exp(-1.0)) * 0.1 / 0.5).epsilon(1e-6));
}
