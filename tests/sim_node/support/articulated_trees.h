// Systems of joints, built in code, for tests and benchmarks.
#pragma once

#include <random>
#include <utility>
#include <vector>

#include "sim_node/behaviour/articulated/articulated_system.h"
#include "sim_node/behaviour/impulse/world.h"

namespace tactus::sim::test {

inline const Eigen::Vector3d kDown(0, 0, -9.81);  // m/s^2

// A rod of length 0.1 m, 50 g and radius 10 mm along +x from the anchor.
inline articulated::LinkDef rod_link(int parent, JointKind joint, const Eigen::Vector3d& anchor,
                                     const Eigen::Vector3d& along = Eigen::Vector3d::UnitX()) {
  const double length = 0.1, mass = 0.05, r = 0.01;
  articulated::LinkDef l;
  l.parent = parent;
  l.joint = joint;
  l.anchor_m = anchor;
  l.mass_kg = mass;
  l.centre_m = anchor + length / 2 * along;
  const double across = mass * (3 * r * r + length * length) / 12, about = mass * r * r / 2;
  l.inertia_kg_m2 = across * Eigen::Matrix3d::Identity() + (about - across) * along * along.transpose();
  l.gravity_m_s2 = kDown;
  return l;
}

// Along +x from the origin, horizontal. Each universal joint rotates about y and z.
inline std::vector<articulated::LinkDef> horizontal_chain(int n, JointKind joint = JointKind::kUniversal,
                                                          const Eigen::Vector3d& first = {0, 1, 0},
                                                          const Eigen::Vector3d& second = {0, 0, 1}) {
  std::vector<articulated::LinkDef> links;
  for (int i = 0; i < n; ++i) {
    links.push_back(rod_link(i - 1, joint, {0.1 * i, 0, 0}));
    links.back().axes[0].axis = first;
    links.back().axes[1].axis = second;
  }
  return links;
}

inline double kinetic_energy_J(articulated::ArticulatedSystem& s) {
  const articulated::Dynamics& placed = s.dynamics();
  double sum = 0;
  for (std::size_t i = 0; i < s.tree().links.size(); ++i) {
    const articulated::LinkDef& d = s.tree().links[i].def;
    const int link = static_cast<int>(i);
    const Eigen::Vector3d spin = placed.rotation(link).transpose() * placed.spin_rad_s(link);
    sum += 0.5 * (d.mass_kg * placed.velocity_at(link, placed.centre_m(link)).squaredNorm() +
                  spin.dot(d.inertia_kg_m2 * spin));
  }
  return sum;
}

// Of gravity and springs; gravity is zero at the origin.
inline double potential_energy_J(articulated::ArticulatedSystem& s) {
  const articulated::Dynamics& placed = s.dynamics();
  const articulated::Tree& tree = s.tree();
  double sum = 0;
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const articulated::LinkDef& d = tree.links[i].def;
    sum -= d.mass_kg * d.gravity_m_s2.dot(placed.centre_m(static_cast<int>(i)));
  }
  for (const articulated::Dof& dof : tree.dofs)
    if (dof.stiffness > 0) {
      const double stretch = s.state().positions[static_cast<std::size_t>(dof.coordinate)] - dof.reference;
      sum += 0.5 * dof.stiffness * stretch * stretch;
    }
  return sum;
}

inline double energy_J(articulated::ArticulatedSystem& s) { return kinetic_energy_J(s) + potential_energy_J(s); }

// Acts along a degree of freedom until it is changed, N m or N.
inline void set_torque(articulated::ArticulatedSystem& s, int dof, double torque) {
  auto saved = s.saved_loads();
  saved.loads.torque[static_cast<std::size_t>(dof)] = torque;
  s.set_loads(saved);
}

// Adds one body per link, in order; returns the index of the first.
inline int add_system(impulse::World& world, articulated::ArticulatedSystem system) {
  std::vector<int> bodies;
  for (std::size_t i = 0; i < system.tree().links.size(); ++i) bodies.push_back(world.add_fixed());
  const int first = bodies.front();
  world.make_system(bodies, std::move(system));
  return first;
}

// A random tree of up to n links with joints of every kind and bodies of every shape.
inline std::vector<articulated::LinkDef> random_tree(int n, bool is_free, std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1, 1);
  const auto vector = [&] { return Eigen::Vector3d(u(random), u(random), u(random)); };
  std::vector<articulated::LinkDef> links;
  for (int i = 0; i < n; ++i) {
    articulated::LinkDef l;
    l.parent = i == 0 ? -1 : static_cast<int>(random() % static_cast<unsigned>(i));
    l.is_free = i == 0 && is_free;
    constexpr JointKind kinds[] = {JointKind::kRevolute, JointKind::kPrismatic, JointKind::kUniversal,
                                   JointKind::kBall, JointKind::kFixed};
    l.joint = kinds[random() % 5];
    l.anchor_m =
        (i == 0 ? Eigen::Vector3d(1, 2, 3) : links[static_cast<std::size_t>(l.parent)].centre_m) + 0.2 * vector();
    l.centre_m = l.anchor_m + 0.2 * vector();
    for (JointAxis& axis : l.axes) axis.axis = vector();
    l.mass_kg = 0.3 + 0.2 * u(random);
    const Eigen::Matrix3d shape = Eigen::Matrix3d::NullaryExpr([&] { return u(random); });
    // The inertia of random points, so it satisfies the conditions of an inertia.
    const Eigen::Matrix3d second = 1e-3 * (shape * shape.transpose() + 0.1 * Eigen::Matrix3d::Identity());
    l.inertia_kg_m2 = second.trace() * Eigen::Matrix3d::Identity() - second;
    l.gravity_m_s2 = kDown;
    links.push_back(l);
  }
  return links;
}

// Sets a random pose and motion.
inline void randomize_state(articulated::ArticulatedSystem& s, std::mt19937& random, double rate = 3) {
  std::uniform_real_distribution<double> u(-1, 1);
  auto state = s.state();
  for (double& q : state.positions) q += u(random);
  for (const articulated::Link& l : s.tree().links) {
    if (!l.def.is_free && l.dofs != 3) continue;
    double* q = state.positions.data() + l.first_coordinate + (l.def.is_free ? 3 : 0);
    Eigen::Map<Eigen::Vector4d>(q).normalize();
  }
  for (double& v : state.rates) v = rate * u(random);
  s.set_state(state);
}

}  // namespace tactus::sim::test
