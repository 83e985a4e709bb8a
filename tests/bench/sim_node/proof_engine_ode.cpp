// ODE alone, set up as in its manual: boxes, spheres, capsules and a plane in a space, a contact joint for each point.
#include <ode/ode.h>

#include <cmath>
#include <vector>

#include "tests/bench/sim_node/proof_engine.h"

namespace tactus::bench {
namespace {

using Eigen::Vector3d;

constexpr double kLength = 0.1, kMass = 0.05, kRadius = 0.01;

Vector3d vec(const dReal* v) { return {v[0], v[1], v[2]}; }

class Ode : public Engine {
 public:
  explicit Ode(bool quick) : quick_(quick) {
    dInitODE2(0);
    dSetMessageHandler([](int, const char*, va_list) {});
    dRandSetSeed(1);
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    joints_ = dJointGroupCreate(0);
    dWorldSetGravity(world_, 0, 0, -kG);
  }
  ~Ode() override {
    dJointGroupDestroy(joints_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
    dCloseODE();
  }
  void set_gravity(const Vector3d& g) override { dWorldSetGravity(world_, g.x(), g.y(), g.z()); }
  void plane(const Vector3d& n, double friction, double restitution) override {
    add_surface(dCreatePlane(space_, n.x(), n.y(), n.z(), 0), friction, restitution);
  }
  int ball(double mass, double r, const Vector3d& place, double friction, double restitution) override {
    dMass m;
    dMassSetSphereTotal(&m, mass, r);
    return add(m, Eigen::Isometry3d(Eigen::Translation3d(place)), dCreateSphere(space_, r), friction, restitution);
  }
  int box(double mass, const Vector3d& s, const Eigen::Isometry3d& pose, double friction,
          double restitution) override {
    dMass m;
    dMassSetBoxTotal(&m, mass, s.x(), s.y(), s.z());
    return add(m, pose, dCreateBox(space_, s.x(), s.y(), s.z()), friction, restitution);
  }
  int rod(double mass, double length, double r, const Eigen::Isometry3d& pose, double friction) override {
    dMass m;
    const double across = mass * length * length / 12, about = mass * r * r / 2;
    dMassSetParameters(&m, mass, 0, 0, 0, about, across, across, 0, 0, 0);
    return add(m, pose, along_x(dCreateCapsule(space_, r, length)), friction, 0);
  }
  void chain(int links, double about_vertical) override {
    for (int i = 0; i < links; ++i) {
      const int b = link(Eigen::Isometry3d(Eigen::Translation3d(kLength * (i + 0.5), 0, 0)));
      const dJointID j = dJointCreateUniversal(world_, nullptr);
      dJointAttach(j, bodies_.back(), i > 0 ? bodies_[bodies_.size() - 2] : nullptr);
      dJointSetUniversalAnchor(j, kLength * i, 0, 0);
      dJointSetUniversalAxis1(j, 0, 0, 1);
      dJointSetUniversalAxis2(j, 0, 1, 0);
      hinges_.push_back(j);
      // As one rod about the vertical: only the first joint rotates.
      dBodySetAngularVel(bodies_.back(), 0, 0, about_vertical);
      dBodySetLinearVel(bodies_.back(), 0, about_vertical * kLength * (i + 0.5), 0);
      static_cast<void>(b);
    }
  }
  int hanging_rod(double restitution) override {
    const int b = link(Eigen::Translation3d(0, 0, -kLength / 2) * Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY()));
    const dGeomID capsule = dCreateCapsule(space_, kRadius, kLength);
    dGeomSetBody(capsule, bodies_.back());
    along_x(capsule);
    add_surface(capsule, 0, restitution);
    const dJointID j = dJointCreateBall(world_, nullptr);
    dJointAttach(j, bodies_.back(), nullptr);
    dJointSetBallAnchor(j, 0, 0, 0);
    return b;
  }
  void pendulum(double angle) override {
    link(Eigen::AngleAxisd(angle, Vector3d::UnitY()) * Eigen::Translation3d(0, 0, -kLength / 2) *
         Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY()));
    const dJointID j = dJointCreateHinge(world_, nullptr);
    dJointAttach(j, bodies_.back(), nullptr);
    dJointSetHingeAnchor(j, 0, 0, 0);
    dJointSetHingeAxis(j, 0, 1, 0);
  }
  void set_motion(int body, const Vector3d& v, const Vector3d& w) override {
    dBodySetLinearVel(at(body), v.x(), v.y(), v.z());
    dBodySetAngularVel(at(body), w.x(), w.y(), w.z());
  }
  void step(double h) override {
    feedback_.clear();
    feedback_.reserve(4096);
    dSpaceCollide(space_, this, &Ode::near);
    quick_ ? dWorldQuickStep(world_, h) : dWorldStep(world_, h);
    force_ = 0;
    for (const Felt& f : feedback_) force_ += std::abs(vec(f.joint.f1).dot(f.normal));
    dJointGroupEmpty(joints_);
  }
  Vector3d position(int body) override { return vec(dBodyGetPosition(at(body))); }
  Eigen::Quaterniond orientation(int body) override {
    const dReal* q = dBodyGetQuaternion(at(body));
    return {q[0], q[1], q[2], q[3]};
  }
  Vector3d velocity(int body) override { return vec(dBodyGetLinearVel(at(body))); }
  Vector3d spin(int body) override { return vec(dBodyGetAngularVel(at(body))); }
  Vector3d link_spin() override { return spin(0); }
  double contact_force_N() override { return force_; }
  double chain_energy_J() override {
    double sum = 0;
    for (const dBodyID b : bodies_) {
      dMass m;
      dBodyGetMass(b, &m);
      dVector3 local;
      const dReal* w = dBodyGetAngularVel(b);
      dBodyVectorFromWorld(b, w[0], w[1], w[2], local);
      sum += m.mass * (vec(dBodyGetLinearVel(b)).squaredNorm() / 2 + kG * dBodyGetPosition(b)[2]);
      for (int k = 0; k < 3; ++k) sum += m.I[5 * k] * local[k] * local[k] / 2;
    }
    return sum;
  }
  double joint_gap_m() override {
    double gap = 0;
    for (const dJointID j : hinges_) {
      dVector3 a, b;
      dJointGetUniversalAnchor(j, a);
      dJointGetUniversalAnchor2(j, b);
      gap = std::max(gap, (vec(a) - vec(b)).norm());
    }
    return gap;
  }
  double pendulum_angle_rad() override {  // ODE's own angle wraps.
    const Vector3d p = vec(dBodyGetPosition(bodies_.back()));
    return std::atan2(-p.x(), -p.z());
  }

 private:
  struct Surface {
    double friction, restitution;
  };
  struct Felt {
    dJointFeedback joint;
    Vector3d normal;
  };
  dBodyID at(int body) const { return bodies_[static_cast<std::size_t>(body)]; }
  static dGeomID along_x(dGeomID capsule) {
    dQuaternion q;
    dQFromAxisAndAngle(q, 0, 1, 0, M_PI / 2);
    if (dGeomGetBody(capsule)) dGeomSetOffsetQuaternion(capsule, q);
    return capsule;
  }
  void add_surface(dGeomID geom, double friction, double restitution) {
    dGeomSetData(geom, reinterpret_cast<void*>(surfaces_.size()));
    surfaces_.push_back({friction, restitution});
  }
  int add(const dMass& mass, const Eigen::Isometry3d& pose, dGeomID geom, double friction, double restitution) {
    const dBodyID b = dBodyCreate(world_);
    dBodySetMass(b, &mass);
    const Vector3d p = pose.translation();
    const Eigen::Quaterniond q(pose.linear());
    const dQuaternion turn = {q.w(), q.x(), q.y(), q.z()};
    dBodySetPosition(b, p.x(), p.y(), p.z());
    dBodySetQuaternion(b, turn);
    bodies_.push_back(b);
    if (geom) {
      dGeomSetBody(geom, b);
      if (dGeomGetClass(geom) == dCapsuleClass) along_x(geom);
      add_surface(geom, friction, restitution);
    }
    return static_cast<int>(bodies_.size()) - 1;
  }
  int link(const Eigen::Isometry3d& pose) {
    dMass m;
    const double across = kMass * (3 * kRadius * kRadius + kLength * kLength) / 12,
                 about = kMass * kRadius * kRadius / 2;
    dMassSetParameters(&m, kMass, 0, 0, 0, about, across, across, 0, 0, 0);
    return add(m, pose, nullptr, 0, 0);
  }
  static void near(void* self, dGeomID a, dGeomID b) {
    Ode& ode = *static_cast<Ode*>(self);
    dContactGeom found[16];
    const int n = dCollide(a, b, 16, found, sizeof(dContactGeom));
    const Surface &sa = ode.surfaces_[reinterpret_cast<std::size_t>(dGeomGetData(a))],
                  &sb = ode.surfaces_[reinterpret_cast<std::size_t>(dGeomGetData(b))];
    for (int i = 0; i < n; ++i) {
      dContact contact{};
      contact.geom = found[i];
      contact.surface.mode = dContactApprox1 | dContactBounce;
      contact.surface.mu = std::sqrt(sa.friction * sb.friction);
      contact.surface.bounce = std::min(sa.restitution, sb.restitution);
      contact.surface.bounce_vel = 0.02;
      const dJointID j = dJointCreateContact(ode.world_, ode.joints_, &contact);
      dJointAttach(j, dGeomGetBody(a), dGeomGetBody(b));
      ode.feedback_.push_back({{}, vec(found[i].normal)});
      dJointSetFeedback(j, &ode.feedback_.back().joint);
    }
  }

  bool quick_;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID joints_;
  std::vector<dBodyID> bodies_;
  std::vector<dJointID> hinges_;
  std::vector<Surface> surfaces_;
  std::vector<Felt> feedback_;
  double force_ = 0;
};

}  // namespace

std::unique_ptr<Engine> make_ode(bool quick) { return std::make_unique<Ode>(quick); }

}  // namespace tactus::bench
