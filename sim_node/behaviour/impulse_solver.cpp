#include "sim_node/behaviour/impulse_solver.h"

#include <algorithm>

#include "sim_node/behaviour/impulse/build_world.h"
#include "sim_node/state/archive_motion.h"

namespace tactus::sim {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

// Contacts that a state may hold: more than a step ever has.
constexpr std::size_t kMostContacts = 1 << 16;

// Of a shape, from the origin of its own frame: all of it, and what turning about the z axis moves.
double bound_of(const ShapeDef& s, const WorldDef& world) {
  switch (s.kind) {
    case ShapeKind::kSphere: return s.size_m.x();
    case ShapeKind::kCapsule: return s.size_m.x() + s.size_m.z() / 2;
    case ShapeKind::kCylinder: return std::hypot(s.size_m.x(), s.size_m.z() / 2);
    case ShapeKind::kMesh: {
      double most = 0;
      for (const Eigen::Vector3d& v : world.meshes[index(s.mesh)].vertices) most = std::max(most, v.norm());
      return most;
    }
    default: return s.size_m.norm() / 2;
  }
}

}  // namespace

std::vector<impulse::Extent> extents_of(const WorldDef& world) {
  std::vector<impulse::Extent> out(world.bodies.size());
  for (const ShapeDef& s : world.shapes) {
    const BodyDef& body = world.bodies[index(s.body)];
    if (body.is_static || body.tool >= 0) continue;
    impulse::Extent& e = out[index(s.body)];
    const double from_centre = (s.pose.translation() - body.centre_of_mass_m).norm(), bound = bound_of(s, world);
    e.bound_m = std::max(e.bound_m, from_centre + bound);
    e.bend_m = std::max(e.bend_m, from_centre + (s.kind == ShapeKind::kSphere ? 0 : bound));
  }
  return out;
}

void SceneContacts::find(std::span<const BodyMotion> motions, std::span<const int> active, double h,
                         std::vector<Manifold>& out) {
  for (const int body : active) bodies_[index(body)] = frames_.motion(body, motions[index(body)]);
  finder_.find(bodies_, active, h, out);
}

ImpulseSolver::ImpulseSolver(const WorldDef& world, const Settings& settings)
    : world_(impulse::build_world(world, settings)),
      source_(world, settings),
      advance_(extents_of(world)),
      step_s_(settings.step_s) {
  for (const BodyDef& b : world.bodies) {
    falls_.push_back(b.gravity);
    centre_in_body_m_.push_back(b.centre_of_mass_m);
  }
  for (const ShapeDef& s : world.shapes) body_of_.push_back(s.body);
  const auto moves = [&](int body) { return body >= 0 && world_->moves(body); };
  for (const JointDef& j : world.joints) {
    if (!moves(j.parent) && !moves(j.child)) continue;
    const bool reversed = !moves(j.child) || (moves(j.parent) && world_->parent_of(j.child) != j.parent);
    joints_.push_back({j.name, reversed ? j.parent : j.child, reversed && j.kind == JointKind::kUniversal});
  }
  bodies_ = source_.frames().at_start(world);
  std::vector<int> units(index(world_->units()));
  for (std::size_t i = 0; i < units.size(); ++i) units[i] = static_cast<int>(i);
  world_->set_active(units);
  look();
}

void ImpulseSolver::read() {
  for (const int body : world_->active_bodies())
    bodies_[index(body)] = source_.frames().motion(body, world_->motions()[index(body)]);
}

// After something was set: the motions and contacts of now.
void ImpulseSolver::look() {
  read();
  source_.find(world_->motions(), world_->active_bodies(), advance_.horizon_s(*world_, step_s_), contacts_);
}

void ImpulseSolver::step(double h) {
  report_ = advance_.step(*world_, source_, h, contacts_, solved_);
  read();
}

void ImpulseSolver::set_gravity(const Eigen::Vector3d& g) {
  for (const int body : world_->active_bodies())
    if (falls_[index(body)]) world_->set_gravity(body, g);
  read();
}

bool ImpulseSolver::set_mass(int body, double mass_kg) {
  if (!world_->set_mass(body, mass_kg)) return false;
  read();
  return true;
}

bool ImpulseSolver::set_pose(int body, const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond(pose.linear()).normalized();
  if (!world_->set_pose(body, pose * centre_in_body_m_[index(body)], turn)) return false;
  look();
  return true;
}

bool ImpulseSolver::set_velocity(int body, const Eigen::Vector3d& v) {
  if (!world_->moves(body)) return false;
  world_->set_velocity(body, v);
  look();
  return true;
}

bool ImpulseSolver::set_spin(int body, const Eigen::Vector3d& w) {
  if (!world_->moves(body)) return false;
  world_->set_spin(body, w);
  look();
  return true;
}

void ImpulseSolver::set_friction(int body, double friction) {
  for (std::size_t s = 0; s < body_of_.size(); ++s)
    if (body_of_[s] == body)
      world_->set_surface(static_cast<int>(s), {friction, world_->surface(static_cast<int>(s)).restitution});
}

void ImpulseSolver::set_restitution(int body, double restitution) {
  for (std::size_t s = 0; s < body_of_.size(); ++s)
    if (body_of_[s] == body)
      world_->set_surface(static_cast<int>(s), {world_->surface(static_cast<int>(s)).friction, restitution});
}

const ImpulseSolver::Joint* ImpulseSolver::joint(const std::string& name) const {
  for (const Joint& j : joints_)
    if (j.name == name) return &j;
  return nullptr;
}

bool ImpulseSolver::set_motor(const std::string& name, int axis, double effort, double velocity) {
  const Joint* j = joint(name);
  return j && world_->set_motor(j->body, axis_of(*j, axis), effort, velocity);
}

bool ImpulseSolver::set_joint_friction(const std::string& name, int axis, double friction) {
  const Joint* j = joint(name);
  return j && world_->set_joint_friction(j->body, axis_of(*j, axis), friction);
}

void ImpulseSolver::archive(StateArchive& a) {
  world_->archive(a);
  if (a.reads()) read();
  for (auto* list : {&contacts_, &solved_})
    a.list(*list, kMostContacts, [&](Manifold& m) { sim::archive(a, m, bodies_.size(), body_of_.size()); });
}

}  // namespace tactus::sim
