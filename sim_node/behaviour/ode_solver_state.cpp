// Changes of Solver while the world runs, and its archive.
#include <algorithm>
#include <cmath>

#include "sim_node/behaviour/impulse_solver.h"
#include "sim_node/behaviour/ode_engine.h"
#include "sim_node/model/archive_motion.h"

namespace tactus::sim {

using impulse::SceneChange;
using ode::to_eigen;

bool Solver::apply(const SceneChange& c) {
  if (impulse_) return impulse_->apply(c);
  switch (c.kind) {
    case SceneChange::kGravity: set_gravity(c.values); return true;
    case SceneChange::kMass: return set_mass(c.body, c.values.x());
    case SceneChange::kFriction:
    case SceneChange::kRestitution:
      for (std::size_t s = 0; s < body_of_.size(); ++s)
        if (body_of_[s] == c.body) (c.kind == SceneChange::kFriction ? friction_ : restitution_)[s] = c.values.x();
      return true;
    case SceneChange::kMotor: return engine_->joints->set_motor(c.joint, c.axis, c.values.x(), c.values.y());
    case SceneChange::kJointFriction: return engine_->joints->set_friction(c.joint, c.axis, c.values.x());
    default: return false;
  }
}

void Solver::set_gravity(const Eigen::Vector3d& g) {
  dWorldSetGravity(engine_->world.get(), g.x(), g.y(), g.z());
  for (std::size_t i = 0; i < inertias_.size(); ++i) {
    if (!has_gravity_[i]) continue;
    free_fall_m_s_[i] += g * settings_.step_s - inertias_[i].gravity_m_s;
    inertias_[i].gravity_m_s = g * settings_.step_s;
  }
}

bool Solver::set_mass(int body, double mass_kg) {
  const auto i = static_cast<std::size_t>(body);
  const dBodyID id = engine_->bodies[i];
  if (!id || engine_->jointed[i]) return false;
  dMass mass;
  dBodyGetMass(id, &mass);
  inertias_[i].inverse_inertia *= mass.mass / mass_kg;
  dMassAdjust(&mass, mass_kg);
  dBodySetMass(id, &mass);
  motions_[i].inverse_mass_1_kg = 1 / mass_kg;
  read_bodies();
  return true;
}

bool Solver::set_pose(int body, const Eigen::Isometry3d& pose) {
  if (impulse_) return impulse_->set_pose(body, pose);
  const auto i = static_cast<std::size_t>(body);
  const dBodyID id = engine_->bodies[i];
  if (!id || engine_->jointed[i]) return false;
  const Eigen::Vector3d p = pose * inertias_[i].centre_in_body_m;
  dQuaternion q;
  ode::set_quaternion(Eigen::Quaterniond(pose.linear()).normalized(), q);
  dBodySetPosition(id, p.x(), p.y(), p.z());
  dBodySetQuaternion(id, q);
  read_bodies();
  engine_->shapes->collide(contacts_);
  return true;
}

bool Solver::set_velocity(int body, const Eigen::Vector3d& v) {
  if (impulse_) return impulse_->set_velocity(body, v);
  const dBodyID id = engine_->bodies[static_cast<std::size_t>(body)];
  if (!id) return false;
  dBodySetLinearVel(id, v.x(), v.y(), v.z());
  read_bodies();
  return true;
}

bool Solver::set_spin(int body, const Eigen::Vector3d& w) {
  if (impulse_) return impulse_->set_spin(body, w);
  const dBodyID id = engine_->bodies[static_cast<std::size_t>(body)];
  if (!id) return false;
  dBodySetAngularVel(id, w.x(), w.y(), w.z());
  read_bodies();
  return true;
}

void Solver::Engine::archive(StateArchive& a, dBodyID id) {
  dMass mass;
  dBodyGetMass(id, &mass);
  a(mass.mass);
  for (dReal& x : mass.I) a(x);
  Eigen::Vector3d p = to_eigen(dBodyGetPosition(id)), v = to_eigen(dBodyGetLinearVel(id)),
                  w = to_eigen(dBodyGetAngularVel(id));
  Eigen::Quaterniond q = ode::quaternion(dBodyGetQuaternion(id));
  a(p), a(v), a(w), a(q);
  if (!a.reads()) return;
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> inertia(mass.I);
  const Eigen::LLT<Eigen::Matrix3d> cholesky(inertia.leftCols<3>());
  a.require(mass.mass > 0 && cholesky.info() == Eigen::Success, "the state holds a mass that is not positive");
  a.require(std::abs(q.squaredNorm() - 1) < 1e-6, "the state holds an invalid orientation");
  a.require(plausible(p, v, w), kImplausible);
  dBodySetMass(id, &mass);
  dBodySetPosition(id, p.x(), p.y(), p.z());
  // dBodySetQuaternion normalises, which may change the last bit, and marks the geoms as moved. They read the pose at
  // the next query.
  dQuaternion exact;
  ode::set_quaternion(q, exact);
  dBodySetQuaternion(id, exact);
  std::copy_n(exact, 4, const_cast<dReal*>(dBodyGetQuaternion(id)));
  dRfromQ(const_cast<dReal*>(dBodyGetRotation(id)), exact);
  dBodySetLinearVel(id, v.x(), v.y(), v.z());
  dBodySetAngularVel(id, w.x(), w.y(), w.z());
  dBodySetForce(id, 0, 0, 0);
  dBodySetTorque(id, 0, 0, 0);
}

void Solver::archive(StateArchive& a) {
  if (impulse_) return impulse_->archive(a);
  a(steps_);
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    if (!engine_->bodies[i]) continue;
    engine_->archive(a, engine_->bodies[i]);
    a(motions_[i].inverse_mass_1_kg);
  }
  engine_->joints->archive(a);
  dVector3 gravity;
  dWorldGetGravity(engine_->world.get(), gravity);
  Eigen::Vector3d g = to_eigen(gravity);
  a(g);
  dWorldSetGravity(engine_->world.get(), g.x(), g.y(), g.z());
  a.fixed(friction_, [&](double& x) { a(x); });
  a.fixed(restitution_, [&](double& x) { a(x); });
  a.fixed(inertias_, [&](BodyInertia& x) { a(x.inverse_inertia), a(x.gravity_m_s); });
  a.fixed(free_fall_m_s_, [&](Eigen::Vector3d& x) { a(x); });
  if (a.reads()) read_bodies();
  for (auto* list : {&contacts_, &solved_})
    a.list(*list, kMaxPoints, [&](Manifold& m) { sim::archive(a, m, motions_.size(), friction_.size()); });
}

}  // namespace tactus::sim
