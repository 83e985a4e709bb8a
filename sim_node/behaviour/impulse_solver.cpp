#include "sim_node/behaviour/impulse_solver.h"

#include <algorithm>

#include "sim_node/behaviour/impulse/build_world.h"
#include "sim_node/model/archive_motion.h"
#include "sim_node/model/index.h"
#include "sim_node/model/tool_shape.h"

namespace tactus::sim {
namespace {

// Maximum number of contacts in a state: more than any step has.
constexpr std::size_t kMaxContacts = 1 << 16;

}  // namespace

std::vector<impulse::Extent> extents_of(const WorldDef& world) {
  std::vector<impulse::Extent> out(world.bodies.size());
  for (const ShapeDef& s : world.shapes) {
    const BodyDef& body = world.bodies[index(s.body)];
    if (body.is_static || body.tool >= 0) continue;
    impulse::Extent& e = out[index(s.body)];
    const double from_centre = (s.pose.translation() - body.centre_of_mass_m).norm(), bound = bound_m(world, s);
    e.bound_m = std::max(e.bound_m, from_centre + bound);
    e.rotation_lever_m = std::max(e.rotation_lever_m, from_centre + (s.kind == ShapeKind::kSphere ? 0 : bound));
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
      stepper_(extents_of(world)),
      step_s_(settings.step_s),
      scene_(world, *world_),
      shapes_(world.shapes.size()) {
  bodies_ = source_.frames().at_start(world);
  std::vector<int> units(index(world_->units()));
  for (std::size_t i = 0; i < units.size(); ++i) units[i] = static_cast<int>(i);
  world_->set_active(units);
  detect_contacts();
}

void ImpulseSolver::read() {
  for (const int body : world_->active_bodies())
    bodies_[index(body)] = source_.frames().motion(body, world_->motions()[index(body)]);
}

// Updates motions and contacts after a change.
void ImpulseSolver::detect_contacts() {
  read();
  source_.find(world_->motions(), world_->active_bodies(), stepper_.horizon_s(*world_, step_s_), contacts_);
}

void ImpulseSolver::step(double h) {
  report_ = stepper_.step(*world_, source_, h, contacts_, solved_);
  source_.frames().place_impacts(solved_);
  read();
}

bool ImpulseSolver::apply(const impulse::SceneChange& change) {
  if (!scene_.apply(*world_, change)) return false;
  read();
  return true;
}

bool ImpulseSolver::set_pose(int body, const Eigen::Isometry3d& pose) {
  if (!scene_.set_pose(*world_, body, pose)) return false;
  detect_contacts();
  return true;
}

bool ImpulseSolver::set_velocity(int body, const Eigen::Vector3d& v) {
  if (!world_->moves(body)) return false;
  world_->set_velocity(body, v);
  detect_contacts();
  return true;
}

bool ImpulseSolver::set_spin(int body, const Eigen::Vector3d& w) {
  if (!world_->moves(body)) return false;
  world_->set_spin(body, w);
  detect_contacts();
  return true;
}

void ImpulseSolver::archive(StateArchive& a) {
  world_->archive(a);
  if (a.reads()) read();
  for (auto* list : {&contacts_, &solved_})
    a.list(*list, kMaxContacts, [&](Manifold& m) { sim::archive(a, m, bodies_.size(), shapes_); });
}

}  // namespace tactus::sim
