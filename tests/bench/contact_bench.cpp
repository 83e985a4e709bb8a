// What a step of many boxes costs: the impulse solver against ODE's QuickStep, on the same contacts, medians of
// interleaved runs.
//
//   bin/contact_bench       boxes apart on the floor and in towers of ten, 20 sweeps or iterations each, 1/240 s
#include <ode/ode.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "tests/sim_node/toys.h"

using namespace tactus::sim;
using namespace tactus::sim::test;

namespace {

constexpr double kH = 1.0 / 240, kSize = 0.1;

struct Scene {
  Toys toys{impulse::Law{.sweeps = 20}};
  dWorldID world = dWorldCreate();
  dJointGroupID joints = dJointGroupCreate(0);
  std::vector<dBodyID> bodies;

  Scene(int boxes, int high) {
    dWorldSetGravity(world, 0, 0, -kToyG);
    toys.plane({0, 0, 1}, {0, 0, 0});
    for (int i = 0; i < boxes; ++i) {
      const int tower = i / high;
      const Eigen::Vector3d p(0.3 * (tower % 25), 0.3 * (tower / 25), kSize * (i % high + 0.5));
      toys.box(0.5, {kSize, kSize, kSize}, Eigen::Isometry3d(Eigen::Translation3d(p)));
      dMass m;
      dMassSetBoxTotal(&m, 0.5, kSize, kSize, kSize);
      bodies.push_back(dBodyCreate(world));
      dBodySetMass(bodies.back(), &m);
      dBodySetPosition(bodies.back(), p.x(), p.y(), p.z());
    }
    toys.collide(0);
  }
  ~Scene() {
    dJointGroupDestroy(joints);
    dWorldDestroy(world);
  }
  // The contacts of the impulse solver's poses; ODE is put there first.
  double ode_us() {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const BodyMotion& m = toys.motion(static_cast<int>(i) + 1);
      dBodySetPosition(bodies[i], m.centre_m.x(), m.centre_m.y(), m.centre_m.z());
      dBodySetLinearVel(bodies[i], m.velocity_m_s.x(), m.velocity_m_s.y(), m.velocity_m_s.z());
      dBodySetAngularVel(bodies[i], m.spin_rad_s.x(), m.spin_rad_s.y(), m.spin_rad_s.z());
    }
    const auto body = [&](int b) { return b == 0 ? nullptr : bodies[static_cast<std::size_t>(b - 1)]; };
    const auto before = std::chrono::steady_clock::now();
    for (const Manifold& m : toys.contacts())
      for (const ManifoldPoint& p : m.used()) {
        dContact c{};
        c.surface.mode = dContactApprox1;
        c.surface.mu = 0.5;
        const bool b_first = m.body_a == 0;
        for (int k = 0; k < 3; ++k)
          c.geom.pos[k] = p.point_m[k], c.geom.normal[k] = b_first ? p.normal[k] : -p.normal[k];
        c.geom.depth = std::max(0.0, p.depth_m);
        const dJointID j = dJointCreateContact(world, joints, &c);
        dJointAttach(j, b_first ? body(m.body_b) : body(m.body_a), b_first ? nullptr : body(m.body_b));
      }
    dWorldQuickStep(world, kH);
    dJointGroupEmpty(joints);
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - before).count();
  }
};

double at(std::vector<double>& v, double share) {
  std::sort(v.begin(), v.end());
  return v[static_cast<std::size_t>(share * (static_cast<double>(v.size()) - 1))];
}

}  // namespace

int main() {
  dInitODE2(0);
  std::printf("%-24s %9s %12s %8s %12s %8s %9s\n", "us a step, 20 sweeps", "contacts", "ours p50", "p99",
              "QuickStep p50", "p99", "sweeps");
  for (const int high : {1, 10})
    for (const int boxes : {10, 100, 500}) {
      Scene s(boxes, high);
      std::vector<double> ours, ode;
      int contacts = 0, sweeps = 0;
      for (int i = 0; i < 300; ++i) {
        s.toys.collide(kH);
        if (i >= 20) ode.push_back(s.ode_us());
        contacts = 0;
        for (const Manifold& m : s.toys.contacts()) contacts += m.count;
        std::vector<Manifold> found = s.toys.contacts();
        const auto before = std::chrono::steady_clock::now();
        s.toys.world.step(found, kH);
        if (i >= 20)
          ours.push_back(
              std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - before).count());
        sweeps = std::max(sweeps, s.toys.world.sweeps_last());
      }
      std::printf("%4d %-19s %9d %12.0f %8.0f %12.0f %8.0f %9d\n", boxes, high > 1 ? "in towers of ten" : "apart",
                  contacts, at(ours, 0.5), at(ours, 0.99), at(ode, 0.5), at(ode, 0.99), sweeps);
    }
  dCloseODE();
}
