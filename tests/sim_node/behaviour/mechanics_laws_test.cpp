#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/sim_node/support/mechanics_laws.h"
#include "tests/sim_node/support/state_hash.h"
#include "tests/sim_node/support/world_files.h"
#include "tests/source_dir.h"

using namespace tactus::sim;
using namespace tactus::sim::test;

namespace {

std::string data(const std::string& folder) { return tactus::source_dir() + "/tests/sim_node/behaviour/data/" + folder; }

LawReport checked(const RandomWorld& w) { return LawChecker(w, {}).run(); }

// A gain over the start: energy above it by more than a ten-thousandth of that in play.
bool gains_energy(const RandomWorld& w, const LawReport& r) { return broken_laws(w, r)[kEnergy]; }

}  // namespace

TEST_CASE("Random worlds without a driving force gain no energy, keep their momentum and do not penetrate") {
  constexpr std::uint64_t kSeed = 1, kWorlds = 6;
  for (const std::string& family : world_families())
    for (std::uint64_t seed = kSeed; seed < kSeed + kWorlds; ++seed) {
      const RandomWorld w = random_world(family, seed);
      const LawReport r = checked(w);
      INFO(family << " " << seed << ": " << r.over_J << " J over " << r.scale_J << " J");
      const auto broken = broken_laws(w, r);
      CHECK_FALSE(broken[kFinite]);
      CHECK_FALSE(broken[kEnergy]);
      // Known rises of 1.4 to 3.2 times the bound: a wobbling disc that is lifted out of overlaps of 5 um, a mesh that closes its
      // first gap, and a body at the edge of a heightmap.
      const bool known = (family == "spinning" && seed == 6) || (family == "mesh" && seed == 5) || (family == "heightmap" && seed == 1);
      if (!known) CHECK_FALSE(broken[kRise]);
      CHECK(r.momentum <= 1e-12);
      if (family != "heightmap") CHECK_FALSE(broken[kOverlap]);  // bodies fall over its edge
    }
}

TEST_CASE("The velocity after a divided step belongs to the middle of the whole step") {
  WorldDef w = empty_world();
  add_floor(w);
  // A plate that turns by 0.1 rad in a step and passes close to the floor, on its way up.
  const int body = add_box(w, 1, {0.2, 0.2, 0.02}, at(0, 0, 0.0105));
  body_of(w, body).velocity_m_s = {0, 0, 2};
  body_of(w, body).spin_rad_s = {0, 0, 100};
  Solver solver(w, {});
  bool divided = false;
  for (int i = 0; i < 20; ++i) {
    solver.step();
    divided |= solver.report()->substeps > 1;
    // Free flight: a parabola, to the rounding of 20 sums.
    CHECK(solver.bodies()[static_cast<std::size_t>(body)].velocity_m_s.z() == Approx(2 - kG * kStep * (i + 0.5)).margin(1e-12));
  }
  CHECK(divided);
}

TEST_CASE("A rod that rolls in circles on a smooth floor keeps its energy") {
  for (const double friction : {0.0, 0.5}) {
    WorldDef w = empty_world();
    add_floor(w, friction);
    // Rolling about its axis while it turns about the vertical: its ends leave their linear paths by 14 um in half a step.
    const double r = 0.0122, length = 0.0918;
    const int body = add_body(w, "rod", 0.234, Eigen::Vector3d(1.73e-4, 1.73e-4, 1.74e-5).asDiagonal(),
                              at(0, 0, r + 2e-5) * Eigen::Isometry3d(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY())));
    add_shape(w, body, ShapeKind::kCylinder, {r, 0, length}, friction);
    body_of(w, body).spin_rad_s = {40, 0, 68};
    Solver solver(w, {});
    const auto energy = [&] {
      const BodyMotion& m = solver.bodies()[static_cast<std::size_t>(body)];
      const Eigen::Vector3d v = m.velocity_m_s + kStep / 2 * w.gravity_m_s2, spin = m.orientation.conjugate() * m.spin_rad_s;
      return 0.5 * 0.234 * v.squaredNorm() + 0.5 * spin.dot(body_of(w, body).inertia_kg_m2 * spin) + 0.234 * kG * m.centre_m.z();
    };
    double least = 1e9, rise = 0;
    for (int i = 0; i < 500; ++i) {
      solver.step();
      least = std::min(least, energy());
      rise = std::max(rise, energy() - least);
    }
    INFO("friction " << friction << ": rise of " << rise << " J over " << least << " J");
    CHECK(rise < 1e-4 * 0.45);  // kinetic energy at the start, J
  }
}

TEST_CASE("Stacks, mass ratios, corners, mesh rooms and touching faces lie still") {
  for (const char* family : {"stack", "ratio", "corner", "mesh_room", "touching"})
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const RandomWorld w = random_world(family, seed);
      const LawReport r = checked(w);
      INFO(family << " " << seed << ": creep " << r.creep_m_s << " m/s, speed " << r.tremble_m_s << " m/s");
      CHECK_FALSE(broken_laws(w, r)[kRest]);
      CHECK(r.held == 0);
    }
}

TEST_CASE("Worlds that once broke a law of mechanics obey it") {
  int worlds = 0;
  for (const auto& file : scenes_in(data("mechanics"))) {
    const RandomWorld w = world_of_file(file);
    const LawReport r = checked(w);
    INFO(file.stem().string() << ": " << r.over_J << " J over " << r.scale_J << " J");
    CHECK(r.finite);
    // 100 kg on 50 g: the distance to the floor that the surfaces close at the start is not known better.
    if (file.stem() != "heavy_on_light") CHECK_FALSE(gains_energy(w, r));
    CHECK(r.overlap_m <= 1.05e-5);
    CHECK(r.missed == 0);
    CHECK(r.momentum <= 1e-12);
    ++worlds;
  }
  CHECK(worlds == 21);
}

TEST_CASE("A tower of twisted cubes, a heavy body on a light one and a box in a mesh corner do not creep") {
  for (const char* name : {"tower_creep", "heavy_on_light_3s", "mesh_corner_rest", "mesh_corner_held"}) {
    const LawReport r = checked(world_of_file(data("mechanics/") + name + ".sdf"));
    INFO(name << ": creep " << r.creep_m_s << " m/s, speed " << r.tremble_m_s << " m/s");
    CHECK(r.creep_m_s < 1e-6);
    CHECK(r.tremble_m_s < 1e-6);
    CHECK(r.held == 0);
  }
}

TEST_CASE("Meshes that tumble to the floor arrive there") {
  const LawReport r = checked(world_of_file(data("mechanics/held_in_the_air.sdf")));
  CHECK(r.held == 0);
  CHECK(r.tremble_m_s < 1e-6);
}

TEST_CASE("Forces of a wedged cylinder and of a corner that three faces share stay near the weight") {
  for (const auto& [name, weight_N] : {std::pair{"one_cylinder_in_a_v", 2.0}, std::pair{"mesh_corner_rest", 10.0}}) {
    const RandomWorld w = world_of_file(data("mechanics/") + name + ".sdf");
    Solver solver(w.world, {});
    double largest = 0;
    for (int i = 0; i < 1000; ++i) {
      solver.step();
      if (i < 500) continue;
      for (const Manifold& m : solver.solved())
        for (const ManifoldPoint& p : m.used()) largest = std::max(largest, p.normal_force_N);
    }
    INFO(name << ": " << largest << " N");
    CHECK(largest < 100 * weight_N);
  }
}

TEST_CASE("A ball that strikes two faces of one mesh in a step is reported with its fastest impact") {
  const RandomWorld w = world_of_file(data("mechanics/mesh_two_faces_one_event.sdf"));
  Solver solver(w.world, {});
  double fastest = 0;
  for (int i = 0; i < 100; ++i) {
    solver.step();
    for (const Manifold& m : solver.solved())
      if (m.impact.count > 0) fastest = std::max(fastest, m.impact.speed_m_s);
  }
  CHECK(fastest == Approx(3).epsilon(0.01));
}

TEST_CASE("Mesh boxes that touch or overlap at the start rest where they are") {
  for (const auto& file : scenes_in(data("touching"))) {
    RandomWorld w = world_of_file(file);
    Solver solver(w.world, {});
    const std::vector<BodyMotion> before(solver.bodies().begin(), solver.bodies().end());
    for (int i = 0; i < 500; ++i) solver.step();
    INFO(file.stem().string());
    for (std::size_t i = 0; i < before.size(); ++i) {
      const BodyMotion& m = solver.bodies()[i];
      REQUIRE(m.centre_m.allFinite());
      // An overlap of 0.1 mm is lifted out, half of it by each of two boxes that float.
      CHECK((m.centre_m - before[i].centre_m).norm() < 1.2e-4);
      CHECK(m.velocity_m_s.norm() < 1e-6);
    }
  }
}
