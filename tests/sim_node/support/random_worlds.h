// Small worlds drawn at random, of named families, without a driving force. Each world is defined by its family and its
// seed. Bodies do not overlap at the start and have gaps of at least 11 um, except in the family "touching".
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/turn_between.h"
#include "tests/sim_node/support/hard_scenes.h"
#include "tests/sim_node/support/meshes.h"
#include "tests/sim_node/support/small_worlds.h"

namespace tactus::sim::test {

// Laws that a world must obey beside energy, overlap and events.
enum class Expectation {
  kMoves,     // nothing more
  kRests,     // all bodies lie still at the end
  kMomentum,  // linear and angular momentum are constant
};

struct RandomWorld {
  WorldDef world;
  double seconds = 1;
  Expectation expectation = Expectation::kMoves;
  bool touching = false;  // bodies may touch or overlap at the start, by overlap_m
  // Slope of bodies that rest without friction: supports settle by different gaps, so what stands on them slides.
  double slope = 0;
  double overlap_m = 0;
};

inline const std::vector<std::string>& world_families() {
  static const std::vector<std::string> names{
      "funnel",   "wedge",   "corner", "supports",     "stack",     "ratio",     "compound", "mesh",
      "heap",     "touching", "blow",  "mesh_room",    "zero_gravity", "spinning", "fast",    "heightmap", "jointed"};
  return names;
}

namespace random_worlds {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Gap between parallel faces of bodies that rest on each other at the start, m: the smallest at which they neither
// overlap nor touch.
inline constexpr double kGap_m = 1.1e-5;

struct Maker {
  Random random;
  WorldDef world = empty_world();
  double friction = 0.5, restitution = 0;

  double draw(double low, double high) { return uniform(random, low, high); }
  double draw_log(double low, double high) { return std::exp(draw(std::log(low), std::log(high))); }
  int pick(int n) { return std::min(n - 1, static_cast<int>(draw(0, n))); }
  template <std::size_t N>
  double one_of(const std::array<double, N>& values) {
    return values[static_cast<std::size_t>(pick(static_cast<int>(N)))];
  }
  void draw_surfaces() {
    friction = one_of(std::array{0.0, 0.1, 0.5, 1.0, 2.0});
    restitution = one_of(std::array{0.0, 0.0, 0.0, 0.3, 0.8, 1.0});
  }
  Eigen::Quaterniond turn() { return Eigen::Quaterniond(Eigen::AngleAxisd(draw(0, 2 * M_PI), direction(random))); }
  Isometry3d pose(const Vector3d& place, const Eigen::Quaterniond& q = Eigen::Quaterniond::Identity()) {
    return Eigen::Translation3d(place) * q;
  }

  int plane(const Vector3d& normal, const Vector3d& through = Vector3d::Zero()) {
    const int body = add_body(world, "side", 0, Eigen::Matrix3d::Identity(),
                              pose(through, turn_between(Vector3d::UnitZ(), normal)));
    add_shape(world, body, ShapeKind::kPlane, {40, 40, 1}, friction, restitution);
    return body;
  }
  int block(const Vector3d& size, const Isometry3d& at) { return add_box(world, 0, size, at, friction, restitution); }
  int box(double mass, const Vector3d& size, const Isometry3d& at) {
    return add_box(world, mass, size, at, friction, restitution);
  }
  int mesh_body(const Soup& soup, double mass, const Vector3d& size, const Isometry3d& at) {
    const int body = add_body(world, "mesh", mass, box_inertia(std::max(mass, 1e-3), size), at);
    const int shape = add_shape(world, body, ShapeKind::kMesh, {1, 1, 1}, friction, restitution);
    world.shapes[static_cast<std::size_t>(shape)].mesh = add_mesh(world, soup);
    return body;
  }
  Soup box_soup(const Vector3d& size) { return sim::test::box(size); }

  // Adds one moving body of a random kind within a ball of this radius.
  int solid(double r, double mass, const Vector3d& place, int kinds = 4) {
    const Isometry3d at = pose(place, turn());
    const int kind = pick(kinds);
    const Vector3d share(draw(0.3, 1), draw(0.3, 1), draw(0.3, 1));
    const Vector3d size = 2 * r * share / share.norm();
    if (kind == 0) return box(mass, size, at);
    if (kind == 1) return add_ball(world, mass, r, place, friction, restitution);
    if (kind == 4) return mesh_body(box_soup(size), mass, size, at);
    if (kind == 5) return mesh_body(icosphere(pick(2), r), mass, Vector3d::Constant(1.4 * r), at);
    const double thin = r * draw(0.2, 0.7), length = kind == 2 ? 2 * std::sqrt(r * r - thin * thin) : 2 * (r - thin);
    const double across = mass * (3 * thin * thin + length * length) / 12 + 1e-12;
    const int body = add_body(world, "rod", mass,
                              Eigen::Matrix3d(Vector3d(across, across, mass * thin * thin / 2).asDiagonal()), at);
    add_shape(world, body, kind == 2 ? ShapeKind::kCylinder : ShapeKind::kCapsule, {thin, 0, length}, friction, restitution);
    return body;
  }
  // Two or three boxes fixed to each other.
  int compound(double r, double mass, const Vector3d& place) {
    const int body = add_body(world, "compound", mass, box_inertia(mass, Vector3d(1, 1, 0.6) * r), pose(place, turn()));
    for (int i = 0, n = 2 + pick(2); i < n; ++i) {
      const int shape = add_shape(world, body, pick(3) ? ShapeKind::kBox : ShapeKind::kSphere,
                                  pick(3) ? Vector3d(0.5 * r, 0.3 * r, 0.2 * r) : Vector3d::Constant(0.2 * r), friction, restitution);
      ShapeDef& s = world.shapes[static_cast<std::size_t>(shape)];
      if (s.kind == ShapeKind::kBox) s.size_m = {0.8 * r, 0.4 * r, 0.3 * r};
      if (s.kind == ShapeKind::kSphere) s.size_m = {0.25 * r, 0, 0};
      s.pose = pose(0.3 * r * direction(random), s.kind == ShapeKind::kBox ? turn() : Eigen::Quaterniond::Identity());
    }
    return body;
  }
  // Bodies one above the other, each in its own ball; lowest: height of the lower edge of the first.
  void drop(int count, double lowest, double narrow, int kinds, double small = 0.02, double large = 0.08) {
    double z = lowest;
    for (int i = 0; i < count; ++i) {
      const double r = draw_log(small, large);
      z += r * narrow + 0.01;
      solid(r, draw_log(0.05, 5), {draw(-0.002, 0.002), draw(-0.002, 0.002), z}, kinds);
      z += r * narrow;
    }
  }
  void throw_all(double speed, double spin) {
    for (BodyDef& b : world.bodies) {
      if (b.is_static) continue;
      b.velocity_m_s = draw(0, speed) * direction(random);
      b.spin_rad_s = draw(0, spin) * direction(random);
    }
  }
  void walls() {
    for (const double side : {-1.0, 1.0}) {
      block({0.2, 1, 7}, pose({side * 0.32, 0, 3.3}));
      block({1, 0.2, 7}, pose({0, side * 0.32, 3.3}));
    }
  }
};

inline RandomWorld funnel(Maker& m) {
  m.draw_surfaces();
  const int sides = 2 + m.pick(3);
  const double steep = m.draw(0.2, 1.3);
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * M_PI * i / sides;
    m.plane({-std::sin(steep) * std::cos(a), -std::sin(steep) * std::sin(a), std::cos(steep)});
  }
  m.drop(1 + m.pick(4), 0.005, 1 / std::cos(steep), 4);
  return {m.world, 1};
}

inline RandomWorld wedge(Maker& m) {
  m.draw_surfaces();
  const double steep = m.draw(0.9, 1.5);
  m.plane({-std::sin(steep), 0, std::cos(steep)});
  m.plane({std::sin(steep), 0, std::cos(steep)});
  m.drop(1 + m.pick(2), 0.003, 1 / std::cos(steep), 4, 0.01, 0.05);
  return {m.world, 1};
}

// A box that is pushed into a wall or a corner by a tilted weight, without friction or with it.
inline RandomWorld corner(Maker& m) {
  m.friction = m.one_of(std::array{0.0, 0.2, 1.0});
  m.plane({0, 0, 1});
  m.plane({1, 0, 0});
  const bool both = m.pick(2);
  if (both) m.plane({0, 1, 0});
  const Vector3d size(m.draw(0.05, 0.2), m.draw(0.05, 0.2), m.draw(0.05, 0.2));
  m.box(m.draw_log(0.1, 10), size, m.pose(size / 2 + Vector3d(kGap_m, both ? kGap_m : 0, kGap_m)));
  m.world.gravity_m_s2 = {m.draw(-2, -0.5), both ? m.draw(-2, -0.5) : 0, -kG};
  return {m.world, 2, Expectation::kRests};
}

inline RandomWorld supports(Maker& m) {
  m.draw_surfaces();
  m.restitution = 0;
  m.plane({0, 0, 1});
  const int posts = 2 + m.pick(3);
  const double height = m.draw(0.05, 0.15), apart = 0.6 / (posts - 1);
  int fixed = 0;
  for (int i = 0; i < posts; ++i) {
    const double x = -0.3 + apart * i;
    if (m.pick(2))
      m.block({0.04, 0.3, height}, m.pose({x, 0, height / 2})), ++fixed;
    else
      m.box(m.draw_log(0.05, 5), {0.08, 0.1, height - kGap_m}, m.pose({x, 0, height / 2 + kGap_m / 2}));
  }
  const Vector3d plank(0.7, 0.1, 0.03);
  m.box(m.draw_log(0.1, 10), plank, m.pose({0, 0, height + plank.z() / 2 + kGap_m}));
  if (m.pick(2)) m.box(m.draw_log(0.1, 20), {0.1, 0.08, 0.1}, m.pose({m.draw(-0.15, 0.15), 0, height + plank.z() + 0.05 + 2 * kGap_m}));
  // A post that moves has a gap more below it than a fixed one.
  const bool even = fixed == 0 || fixed == posts;
  return {m.world, 2, Expectation::kRests, false, m.friction > 0 || even ? 0 : kGap_m / apart};
}

inline RandomWorld stack(Maker& m) {
  m.friction = m.one_of(std::array{0.3, 0.5, 1.0});
  m.plane({0, 0, 1});
  double z = kGap_m;
  const double twist = m.pick(2) ? m.draw(0, 0.7) : 0;
  for (int i = 0, n = 2 + m.pick(9); i < n; ++i) {
    const double s = m.draw(0.07, 0.12);
    m.box(m.draw(0.5, 2), {s, s, 0.1}, m.pose({m.draw(-0.01, 0.01), m.draw(-0.01, 0.01), z + 0.05},
          Eigen::Quaterniond(Eigen::AngleAxisd(i % 2 ? twist : 0, Vector3d::UnitZ()))));
    z += 0.1 + kGap_m;
  }
  return {m.world, 3, Expectation::kRests};
}

inline RandomWorld ratio(Maker& m) {
  m.friction = m.one_of(std::array{0.3, 1.0});
  m.plane({0, 0, 1});
  double z = kGap_m, mass = m.draw_log(0.02, 0.2);
  for (int i = 0, n = 2 + m.pick(2); i < n; ++i) {
    const double s = m.draw(0.06, 0.1);
    m.box(mass, {s, s, 0.06}, m.pose({m.draw(-0.005, 0.005), m.draw(-0.005, 0.005), z + 0.03}));
    z += 0.06 + kGap_m;
    mass *= m.draw_log(30, i ? 100 : 10000);
  }
  return {m.world, 2, Expectation::kRests};
}

inline RandomWorld compound(Maker& m) {
  m.draw_surfaces();
  m.plane({0, 0, 1});
  double z = 0.02;
  for (int i = 0, n = 1 + m.pick(4); i < n; ++i) {
    const double r = m.draw(0.05, 0.12);
    z += 1.1 * r;
    m.compound(r, m.draw_log(0.1, 5), {m.draw(-0.01, 0.01), m.draw(-0.01, 0.01), z});
    z += 1.1 * r;
  }
  return {m.world, 1.5};
}

inline RandomWorld mesh(Maker& m) {
  m.draw_surfaces();
  m.block({40, 40, 1}, m.pose({0, 0, -0.5}));
  m.drop(1 + m.pick(4), 0.01, 1, 6, 0.04, 0.1);
  return {m.world, 1};
}

inline RandomWorld walled_heap(Maker& m) {
  m.draw_surfaces();
  m.plane({0, 0, 1});
  m.walls();
  m.drop(4 + m.pick(6), 0.01, 1, 5, 0.03, 0.1);
  return {m.world, 1.2};
}

// Parallel faces that touch or overlap slightly at the start, of boxes and meshes.
inline RandomWorld touching(Maker& m) {
  m.friction = m.one_of(std::array{0.2, 0.5, 1.0});
  const double overlap = m.one_of(std::array{0.0, 0.0, 1e-6, 1e-5, 1e-4, 1e-3});
  const bool floats = m.pick(4) == 0;
  if (floats) m.world.gravity_m_s2.setZero();
  const auto add = [&](double mass, const Vector3d& size, const Isometry3d& at) {
    if (m.pick(3)) m.mesh_body(m.box_soup(size), mass, size, at);
    else m.box(mass, size, at);
  };
  double z = 0;
  if (!floats) add(0, {m.one_of(std::array{0.1, 1.0, 40.0}), 1, 1}, m.pose({0, 0, -0.5}));
  for (int i = 0, n = 1 + m.pick(2) + floats; i < n; ++i) {
    const double s = m.one_of(std::array{0.05, 0.1, 0.1, 0.2});
    add(m.draw_log(0.3, 3), {s, s, 0.1}, m.pose({0, 0, z + 0.05 - (i || !floats ? overlap : 0)}));
    z += 0.1 - (i || !floats ? overlap : 0);
  }
  return {m.world, 1, Expectation::kRests, true, 0, overlap};
}

// One body strikes a wall or another one: restitution with friction.
inline RandomWorld blow(Maker& m) {
  m.world.gravity_m_s2.setZero();
  m.friction = m.one_of(std::array{0.0, 0.2, 0.5, 1.0, 2.0});
  m.restitution = m.one_of(std::array{0.0, 0.5, 0.8, 1.0});
  m.plane({0, 0, 1});
  const double r = m.draw(0.03, 0.1);
  const int body = m.solid(r, m.draw_log(0.1, 5), {0, 0, 1.3 * r}, 4);
  BodyDef& b = body_of(m.world, body);
  b.velocity_m_s = Vector3d(m.draw(-5, 5), m.draw(-5, 5), m.draw(-8, -1));
  b.spin_rad_s = m.draw(0, 60) * direction(m.random);
  return {m.world, 0.2};
}

// A box in the corner of one mesh that has floor and two walls.
inline RandomWorld mesh_room(Maker& m) {
  m.friction = m.one_of(std::array{0.0, 0.3, 1.0});
  Soup room = m.box_soup({2, 2, 1});
  for (Vector3d& v : room.vertices) v += Vector3d(0.8, 0.8, -0.5);
  Soup wall = m.box_soup({0.8, 2, 2});
  room.add(wall, at(-0.4, 0.8, 1));
  Soup other = m.box_soup({2, 0.8, 2});
  room.add(other, at(0.8, -0.4, 1));
  m.mesh_body(room, 0, {1, 1, 1}, at(0, 0, 0));
  const Vector3d size(m.draw(0.06, 0.2), m.draw(0.06, 0.2), m.draw(0.06, 0.2));
  const bool slides = m.pick(2);
  const double away = slides ? m.draw(0.001, 0.01) : kGap_m;
  const Isometry3d where = m.pose(size / 2 + Vector3d(away, away, kGap_m));
  const double mass = m.draw_log(0.3, 5);
  if (m.pick(2)) m.box(mass, size, where);
  else m.mesh_body(m.box_soup(size), mass, size, where);
  m.world.gravity_m_s2 = {m.draw(-2, -0.5), m.draw(-2, -0.5), -kG};
  return {m.world, 2, slides && m.friction > 0 ? Expectation::kMoves : Expectation::kRests};
}

inline RandomWorld zero_gravity(Maker& m) {
  m.draw_surfaces();
  m.world.gravity_m_s2.setZero();
  for (int i = 0, n = 2 + m.pick(5); i < n; ++i) {
    const double r = m.draw_log(0.03, 0.1);
    m.solid(r, m.draw_log(0.05, 5), {0.21 * (i % 3 - 1), 0.21 * (i / 3), 0}, 6);
  }
  m.throw_all(4, 10);
  for (BodyDef& b : m.world.bodies) b.velocity_m_s += -6 * (b.pose.translation() - Vector3d(0, 0.1, 0));
  return {m.world, 0.6, Expectation::kMomentum};
}

inline RandomWorld spinning(Maker& m) {
  m.draw_surfaces();
  m.plane({0, 0, 1});
  for (int i = 0, n = 1 + m.pick(4); i < n; ++i) m.solid(m.draw(0.03, 0.09), m.draw_log(0.1, 3), {0.2 * (i % 2), 0.2 * (i / 2), m.draw(0.1, 0.3)}, 4);
  m.throw_all(2, 120);
  return {m.world, 0.8};
}

inline RandomWorld fast(Maker& m) {
  m.draw_surfaces();
  m.block({1, 1, 0.001}, m.pose({0, 0, 0}));
  for (int i = 0, n = 1 + m.pick(3); i < n; ++i) {
    const int body = m.solid(m.draw(0.01, 0.05), m.draw_log(0.05, 2), {0.15 * i - 0.15, 0, 0.3 + 0.05 * i}, 4);
    body_of(m.world, body).velocity_m_s = {m.draw(-3, 3), m.draw(-3, 3), -m.draw(10, 50)};
    body_of(m.world, body).spin_rad_s = m.draw(0, 50) * direction(m.random);
  }
  return {m.world, 0.15};
}

inline RandomWorld heightmap(Maker& m) {
  m.draw_surfaces();
  Heightfield f;
  f.columns = f.rows = 17;
  f.size_m = {2, 2, 0.2};
  for (int i = 0; i < f.columns * f.rows; ++i) f.heights_m.push_back(m.draw(0, 0.08));
  const int body = add_body(m.world, "ground", 0, Eigen::Matrix3d::Identity(), at(0, 0, 0));
  const int shape = add_shape(m.world, body, ShapeKind::kHeightfield, f.size_m, m.friction, m.restitution);
  m.world.shapes[static_cast<std::size_t>(shape)].mesh = static_cast<int>(m.world.heightfields.size());
  m.world.heightfields.push_back(f);
  m.drop(1 + m.pick(3), 0.12, 1, 6, 0.03, 0.08);
  return {m.world, 1};
}

inline RandomWorld jointed(Maker& m) {
  m.draw_surfaces();
  WorldDef chain = chain_world(2 + m.pick(5), 0.08, m.draw_log(0.02, 0.5), 0.6);
  chain.gravity_m_s2 = m.world.gravity_m_s2;
  m.world = chain;
  const Isometry3d lie = at(0, 0, 0.6) * Eigen::AngleAxisd(m.draw(-1.5, 1.5), direction(m.random)) * at(0, 0, -0.6);
  for (BodyDef& b : m.world.bodies) b.pose = lie * b.pose;
  for (JointDef& j : m.world.joints) {
    j.anchor_m = lie * j.anchor_m;
    for (JointAxis& a : j.axes) a.axis = lie.linear() * a.axis;
  }
  for (ShapeDef& s : m.world.shapes) s.friction = m.friction, s.restitution = m.restitution;
  m.plane({0, 0, 1});
  m.block({0.05, 1, 0.3}, m.pose({-0.55, 0, 0.15}));
  m.solid(0.04, m.draw_log(0.05, 1), {0.55, 0.1, 0.05}, 4);
  return {m.world, 1};
}

}  // namespace random_worlds

// The same family and seed give the same world.
inline RandomWorld random_world(const std::string& family, std::uint64_t seed) {
  using namespace random_worlds;
  using Make = RandomWorld (*)(Maker&);
  static constexpr Make makers[]{&funnel, &wedge, &corner, &supports, &stack, &ratio, &compound, &mesh, &walled_heap,
                                     &touching, &blow, &mesh_room, &zero_gravity, &spinning, &fast, &heightmap, &jointed};
  Maker m;
  m.random = Random(seed);
  for (std::size_t i = 0; i < std::size(makers); ++i)
    if (world_families()[i] == family) return makers[i](m);
  throw std::invalid_argument("random_world: no family \"" + family + "\"");
}

}  // namespace tactus::sim::test
