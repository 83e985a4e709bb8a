// Cost of a step of many boxes: the impulse solver against ODE's QuickStep on the same contacts; then the whole step, with contact
// detection and separation of surfaces at the default settings, against ODE's dSpaceCollide and QuickStep. Medians of interleaved runs.
//
//    bin/contact_bench [--json FILE]      boxes apart on the floor and in towers of ten, 1/240 s
#include <ode/ode.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "sim_node/behaviour/solver.h"
#include "sync/node/node_options.h"
#include "tests/sim_node/support/small_worlds.h"
#include "tests/sim_node/support/toys.h"

using namespace tactus::sim;
using namespace tactus::sim::test;

namespace {

constexpr double kH = 1.0 / 240, kSize = 0.1;

struct Scene {
  Toys toys{impulse::ContactLaw{.sweeps = 20}};
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
  // The same contacts as those of the impulse solver: its poses are first copied to ODE.
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

using Clock = std::chrono::steady_clock;
double us_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
}

// Position of a box.
Eigen::Vector3d place(int i, int high) {
  const int tower = i / high;
  return {0.3 * (tower % 25), 0.3 * (tower / 25), kSize * (i % high + 0.5)};
}

// The same boxes with the whole step, in our world and in one of ODE.
class OdeWorld {
 public:
  OdeWorld(int boxes, int high) {
    WorldDef w = empty_world();
    add_floor(w);
    for (int i = 0; i < boxes; ++i)
      add_box(w, 0.5, {kSize, kSize, kSize}, Eigen::Isometry3d(Eigen::Translation3d(place(i, high))));
    Settings s;
    s.step_s = kH;
    solver_ = std::make_unique<Solver>(w, s);
    dWorldSetGravity(world_, 0, 0, -kG);
    dWorldSetQuickStepNumIterations(world_, s.iterations);
    dCreatePlane(space_, 0, 0, 1, 0);
    for (int i = 0; i < boxes; ++i) {
      const Eigen::Vector3d p = place(i, high);
      dMass m;
      dMassSetBoxTotal(&m, 0.5, kSize, kSize, kSize);
      const dBodyID body = dBodyCreate(world_);
      dBodySetMass(body, &m);
      dBodySetPosition(body, p.x(), p.y(), p.z());
      dGeomSetBody(dCreateBox(space_, kSize, kSize, kSize), body);
    }
  }
  ~OdeWorld() {
    dJointGroupDestroy(joints_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }
  OdeWorld(const OdeWorld&) = delete;
  OdeWorld& operator=(const OdeWorld&) = delete;

  double ours_us() {
    const auto begin = Clock::now();
    solver_->step();
    return us_since(begin);
  }
  // Duration of the whole step; quick: the part of its QuickStep.
  double ode_us(double& quick) {
    const auto begin = Clock::now();
    dSpaceCollide(space_, this, &OdeWorld::collide);
    const auto found = Clock::now();
    dWorldQuickStep(world_, kH);
    quick = us_since(found);
    dJointGroupEmpty(joints_);
    return us_since(begin);
  }
  int contacts() const {
    int sum = 0;
    for (const Manifold& m : solver_->contacts()) sum += m.count;
    return sum;
  }

 private:
  static void collide(void* whole, dGeomID a, dGeomID b) {
    const OdeWorld& w = *static_cast<OdeWorld*>(whole);
    dContact c[4]{};
    const int n = dCollide(a, b, 4, &c[0].geom, sizeof(dContact));
    for (int i = 0; i < n; ++i) {
      c[i].surface.mode = dContactApprox1;
      c[i].surface.mu = 0.5;
      dJointAttach(dJointCreateContact(w.world_, w.joints_, &c[i]), dGeomGetBody(a), dGeomGetBody(b));
    }
  }

  std::unique_ptr<Solver> solver_;
  dWorldID world_ = dWorldCreate();
  dSpaceID space_ = dHashSpaceCreate(nullptr);
  dJointGroupID joints_ = dJointGroupCreate(0);
};

double at(std::vector<double>& v, double share) {
  std::sort(v.begin(), v.end());
  return v[static_cast<std::size_t>(share * (static_cast<double>(v.size()) - 1))];
}

nlohmann::json solving(int boxes, int high) {
  Scene s(boxes, high);
  std::vector<double> ours, ode;
  int contacts = 0, sweeps = 0;
  for (int i = 0; i < 300; ++i) {
    s.toys.collide(kH);
    if (i >= 20) ode.push_back(s.ode_us());
    contacts = 0;
    for (const Manifold& m : s.toys.contacts()) contacts += m.count;
    std::vector<Manifold> found = s.toys.contacts();
    const auto before = Clock::now();
    s.toys.world.step(found, kH);
    if (i >= 20) ours.push_back(us_since(before));
    sweeps = std::max(sweeps, s.toys.world.sweeps_last());
  }
  const char* how = high > 1 ? "in towers of ten" : "apart";
  std::printf("%4d %-19s %9d %12.0f %8.0f %12.0f %8.0f %9d\n", boxes, how, contacts, at(ours, 0.5), at(ours, 0.99),
              at(ode, 0.5), at(ode, 0.99), sweeps);
  return {{"boxes", boxes},
          {"how", how},
          {"contacts", contacts},
          {"ours_us_p50", at(ours, 0.5)},
          {"ours_us_p99", at(ours, 0.99)},
          {"quick_us_p50", at(ode, 0.5)},
          {"quick_us_p99", at(ode, 0.99)},
          {"sweeps", sweeps}};
}

nlohmann::json whole(int boxes, int high) {
  OdeWorld s(boxes, high);
  std::vector<double> ours, ode, quick;
  for (int i = 0; i < 300; ++i) {
    double q = 0;
    const double by_ode = s.ode_us(q), by_us = s.ours_us();
    if (i < 20) continue;
    ours.push_back(by_us), ode.push_back(by_ode), quick.push_back(q);
  }
  const char* how = high > 1 ? "in towers of ten" : "apart";
  const double ratio = at(ours, 0.5) / at(quick, 0.5);
  std::printf("%4d %-19s %9d %12.0f %8.0f %12.0f %8.0f %12.0f %9.2f\n", boxes, how, s.contacts(), at(ours, 0.5),
              at(ours, 0.99), at(ode, 0.5), at(ode, 0.99), at(quick, 0.5), ratio);
  return {{"boxes", boxes},
          {"how", how},
          {"contacts", s.contacts()},
          {"ours_us_p50", at(ours, 0.5)},
          {"ours_us_p99", at(ours, 0.99)},
          {"ode_us_p50", at(ode, 0.5)},
          {"ode_us_p99", at(ode, 0.99)},
          {"ode_quick_us_p50", at(quick, 0.5)},
          {"ours_by_quick", ratio}};
}

}  // namespace

int main(int argc, char** argv) {
  tactus::sync::Arguments app("Cost of a step with many boxes, ours and ODE");
  std::string file;
  std::vector<int> sizes{10, 100, 500}, heights{1, 10};
  bool whole_only = false;
  app.add_option("--json", file, "writes the figures here");
  app.add_option("--boxes", sizes, "how many").show_default();
  app.add_option("--high", heights, "boxes in a tower").show_default();
  app.add_flag("--whole", whole_only, "only the whole step");
  tactus::sync::parse_or_exit(app, "contact_bench", argc, argv);
  dInitODE2(0);
  nlohmann::json out;
  if (!whole_only) {
    std::printf("%-24s %9s %12s %8s %12s %8s %9s\n", "us a step, 20 sweeps", "contacts", "ours p50", "p99",
                "QuickStep p50", "p99", "sweeps");
    for (const int high : heights)
      for (const int boxes : sizes) out["solving"].push_back(solving(boxes, high));
    std::printf("\n");
  }
  std::printf("%-24s %9s %12s %8s %12s %8s %12s %9s\n", "us a step, whole", "contacts", "ours p50", "p99",
              "ODE p50", "p99", "its QuickStep", "ours by it");
  for (const int high : heights)
    for (const int boxes : sizes) out["whole"].push_back(whole(boxes, high));
  dCloseODE();
  if (!file.empty()) std::ofstream(file) << out.dump(1) << "\n";
}
