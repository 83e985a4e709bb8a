// A tool with a shape among bodies: its possible contacts, and how they follow its motion.
#include <catch2/catch.hpp>
#include <numeric>
#include <set>
#include <tactus/contact_event_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "sim_node/world/simulation.h"
#include "sim_node/model/tool_shape.h"
#include "tests/sim_node/support/simple_hand.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

WorldDef with_tool(WorldDef w, std::int8_t shape, const Vector3d& size, const Vector3d& place) {
  add_tool(w, place);
  tool_def_t& t = w.tools.back();
  t.shape = shape;
  t.size_m = to_vec3(size);
  t.radius_m = bound_m(w, tool_shape(t));
  return w;
}

tool_state_t state(const Vector3d& place, const Eigen::Quaterniond& turn, std::int64_t ns, std::int64_t seq) {
  tool_state_t m{};
  m.header.sim_time_ns = ns;
  m.header.publish_time_ns = 1'000'000'000 + ns;
  m.header.incarnation = 40;
  m.header.seq = seq;
  m.device.position_m = m.proxy.position_m = to_vec3(place);
  m.device.orientation = m.proxy.orientation = to_quat(turn);
  return m;
}

Eigen::Quaterniond about(const Vector3d& axis, double rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(rad, axis));
}

// Height of the tool point of a plane over that plane.
double height(const touch_plane_t& p, const Vector3d& place, const Eigen::Quaterniond& turn) {
  return to_eigen(p.normal).dot(place + turn * to_eigen(p.tool_point_m) - to_eigen(p.point_m));
}

}  // namespace

TEST_CASE("A box over a floor has contacts at its lower corners, with stable ids") {
  WorldDef w = empty_world();
  add_floor(w);
  const Vector3d size(0.04, 0.06, 0.02);
  Simulation s(with_tool(w, tool_def_t::BOX, size, {0, 0, 0.02}), {});
  s.start(1);
  std::set<std::int64_t> ids;
  for (int i = 0; i < 500; ++i) {
    const Vector3d place(1e-4 * i, 0, 0.0125);
    const Eigen::Quaterniond turn = about({0.6, 0.8, 0}, 0.05 * std::sin(0.02 * i));
    s.step(std::vector{state(place, turn, sync::to_ns(s.now()), i)});
    if (i < 2) continue;
    const touch_model_t& m = s.touch_models()[0];
    CAPTURE(i);
    REQUIRE(m.plane_count == 4);
    for (const touch_plane_t& p : m.planes) {
      ids.insert(p.contact_id);
      // A corner, except for the skin.
      const Vector3d corner = to_eigen(p.tool_point_m).cwiseAbs() - 0.5 * size;
      CHECK(corner.cwiseAbs().maxCoeff() < 2.1e-4);
      CHECK(to_eigen(p.normal).z() == Approx(1));
      const double lowest = (place + turn * to_eigen(p.tool_point_m)).z();
      CHECK(height(p, place, turn) == Approx(lowest).margin(1e-6));
    }
  }
  CHECK(ids.size() == 4);
}

TEST_CASE("Planes of near surfaces touch a capsule and a box on every side and never cut into them") {
  WorldDef w = empty_world();
  add_floor(w);
  for (int i = 0; i < 10; ++i)
    add_ball(w, 0, 0.004, {0.022 * std::cos(0.628 * i), 0.022 * std::sin(0.628 * i), 0.02});
  for (const std::int8_t shape : {tool_def_t::BOX, tool_def_t::CAPSULE}) {
    const bool box = shape == tool_def_t::BOX;
    const Vector3d place(0, 0, box ? 0.012 : 0.023);
    Simulation s(with_tool(w, shape, box ? Vector3d(0.025, 0.025, 0.02) : Vector3d(0.012, 0, 0.02), place), {});
    s.start(1);
    for (int i = 0; i < 3; ++i)
      s.step(std::vector{state(place, Eigen::Quaterniond::Identity(), sync::to_ns(s.now()), i)});
    const touch_model_t& m = s.touch_models()[0];
    CHECK(m.planes.size() > 8);
    for (const touch_plane_t& p : m.planes) CHECK(height(p, place, Eigen::Quaterniond::Identity()) > 0);
    for (std::size_t i = 1; i < m.planes.size(); ++i)
      CHECK(height(m.planes[i], place, Eigen::Quaterniond::Identity()) >=
            height(m.planes[i - 1], place, Eigen::Quaterniond::Identity()) - 1e-6);  // nearest first
  }
}

TEST_CASE("The contact of a corner begins when it touches the floor and ends when it leaves") {
  WorldDef w = empty_world();
  add_floor(w);
  Simulation s(with_tool(w, tool_def_t::BOX, {0.04, 0.04, 0.02}, {0, 0, 0.03}), {});
  s.start(1);
  // Tipped: one edge first.
  const Eigen::Quaterniond turn = about(Vector3d::UnitY(), 0.2);
  int begins = 0, ends = 0, hits = 0;
  for (int i = 0; i < 400; ++i) {
    const double z = 0.03 - 0.1 * 1e-3 * std::min(i, 170) + 0.1 * 1e-3 * std::max(0, i - 250);
    tool_state_t m = state({0, 0, z}, turn, sync::to_ns(s.now()), i);
    m.device_velocity_m_s.z = i < 170 ? -0.1f : i > 250 ? 0.1f : 0;
    // The proxy stays on the floor.
    const double lowest = z + (turn * Vector3d(0.02, 0, -0.01)).z() - 0.0001;
    if (lowest < 0) m.proxy.position_m.z -= lowest;
    s.step(std::vector{m});
    for (const contact_event_t& e : s.events()) {
      begins += e.kind == contact_event_t::BEGIN;
      hits += e.kind == contact_event_t::HIT;
      ends += e.kind == contact_event_t::END;
    }
  }
  CHECK(begins == 2);
  CHECK(hits == 2);
  CHECK(ends == 2);
}

TEST_CASE("A tool keeps its nearest 49 contacts in a repeatable order") {
  // Eighty balls under a box, each within the gap of a touch, with the nearest ones anywhere among them.
  constexpr int kBalls = 80;
  const auto gap_m = [](int ball) { return 1e-6 * (1 + ball * 37 % kBalls); };
  const auto touched = [&](bool backwards, std::vector<std::uint8_t>& bytes) {
    WorldDef w = empty_world(0);
    for (int k = 0; k < kBalls; ++k) {
      const int ball = backwards ? kBalls - 1 - k : k;
      add_ball(w, 0, 0.003, {0.008 * (ball % 10), 0.008 * (ball / 10), -0.003 - gap_m(ball)});
      w.bodies.back().name = std::to_string(ball);
    }
    const Vector3d place(0.036, 0.028, 0.0101);
    Simulation s(with_tool(w, tool_def_t::BOX, {0.1, 0.1, 0.02}, place), {});
    s.start(1);
    std::vector<int> balls;
    for (int i = 0; i < 5; ++i) {
      s.step(std::vector{state(place, Eigen::Quaterniond::Identity(), sync::to_ns(s.now()), i)});
      const touch_model_t& m = s.touch_models()[0];
      REQUIRE(m.planes.size() == 49);
      CHECK(m.plane_count == 49);
      bytes.resize(bytes.size() + static_cast<std::size_t>(m.getEncodedSize()));
      m.encode(bytes.data(), static_cast<int>(bytes.size()) - m.getEncodedSize(), m.getEncodedSize());
      balls.clear();
      for (const touch_plane_t& p : m.planes)
        balls.push_back(std::stoi(w.bodies[static_cast<std::size_t>(p.body)].name));
    }
    return balls;
  };
  std::vector<int> nearest(kBalls);
  std::iota(nearest.begin(), nearest.end(), 0);
  std::sort(nearest.begin(), nearest.end(), [&](int x, int y) { return gap_m(x) < gap_m(y); });
  nearest.resize(49);
  std::vector<std::uint8_t> once, again, backwards;
  CHECK(touched(false, once) == nearest);
  CHECK(touched(false, again) == nearest);
  CHECK(once == again);
  CHECK(touched(true, backwards) == nearest);
}
