// Changes of a world between its steps.
#include "sim_node/behaviour/impulse/world.h"

namespace tactus::sim::impulse {

// Updates the motions of the links after a change of state.
void World::refresh(System& s) {
  s.system.dynamics();
  for (std::size_t i = 0; i < s.bodies.size(); ++i)
    motions_[index(s.bodies[i])] = s.system.motion(static_cast<int>(i));
}

void World::set_gravity(int body, const Eigen::Vector3d& g) {
  const Mover& m = movers_[index(body)];
  if (m.kind == Kind::kLink) systems_[index(m.index)].system.set_gravity(m.link, g);
  if (m.kind != Kind::kFree) return;
  FreeBody& b = free_[index(m.index)];
  // The stored velocity is half a step old, under the old gravity.
  b.velocity_m_s = velocity_for(b, 0);
  if (b.step_s >= 0) b.step_s = 0;
  b.gravity_m_s2 = g;
  motions_[index(body)] = motion_of(b);
}

bool World::set_mass(int body, double mass_kg) {
  const Mover& m = movers_[index(body)];
  if (m.kind != Kind::kFree) return false;
  FreeBody& b = free_[index(m.index)];
  b.inertia_kg_m2 *= mass_kg / b.mass_kg;
  b.mass_kg = mass_kg;
  motions_[index(body)] = motion_of(b);
  return true;
}

bool World::set_pose(int body, const Eigen::Vector3d& centre_m, const Eigen::Quaterniond& orientation) {
  const Mover& m = movers_[index(body)];
  if (m.kind != Kind::kFree) return false;
  FreeBody& b = free_[index(m.index)];
  b.centre_m = centre_m;
  b.orientation = orientation;
  motions_[index(body)] = motion_of(b);
  return true;
}

void World::set_velocity(int body, const Eigen::Vector3d& v) {
  const Mover& m = movers_[index(body)];
  if (m.kind == Kind::kFree) {
    FreeBody& b = free_[index(m.index)];
    b.velocity_m_s = v;
    b.step_s = 0;
    motions_[index(body)] = motion_of(b);
  }
  if (m.kind != Kind::kLink) return;
  System& s = systems_[index(m.index)];
  articulated::Dynamics& d = s.system.dynamics();
  const Eigen::Vector3d centre = d.centre_m(m.link), by = v - d.velocity_at(m.link, centre);
  scratch_.resize(s.system.tree().dofs.size());
  d.impulse_to_rates(m.link, centre, s.system.tree().links[index(m.link)].def.mass_kg * by, scratch_);
  s.system.add_rates(scratch_);
  refresh(s);
}

void World::set_spin(int body, const Eigen::Vector3d& w) {
  const Mover& m = movers_[index(body)];
  if (m.kind == Kind::kFree) {
    free_[index(m.index)].spin_rad_s = w;
    motions_[index(body)] = motion_of(free_[index(m.index)]);
  }
  if (m.kind != Kind::kLink) return;
  System& s = systems_[index(m.index)];
  articulated::Dynamics& d = s.system.dynamics();
  const Eigen::Matrix3d turn = d.rotation(m.link);
  const Eigen::Matrix3d inertia = turn * s.system.tree().links[index(m.link)].def.inertia_kg_m2 * turn.transpose();
  scratch_.resize(s.system.tree().dofs.size());
  d.angular_impulse_to_rates(m.link, inertia * (w - d.spin_rad_s(m.link)), scratch_);
  s.system.add_rates(scratch_);
  refresh(s);
}

// Returns -1 when there is none.
int World::dof_of(int body, int axis) const {
  const Mover& m = movers_[index(body)];
  if (m.kind != Kind::kLink) return -1;
  const articulated::Link& l = systems_[index(m.index)].system.tree().links[index(m.link)];
  const bool has_axes = !l.def.is_free && l.def.joint != JointKind::kBall && l.def.joint != JointKind::kFixed;
  return has_axes && axis >= 0 && axis < l.dofs ? l.first_dof + axis : -1;
}

bool World::set_motor(int body, int axis, double effort, double rate) {
  const int dof = dof_of(body, axis);
  if (dof < 0) return false;
  System& s = systems_[index(movers_[index(body)].index)];
  s.system.set_motor(dof, effort, rate);
  s.has_rows = needs_rows(s.system);
  return true;
}

bool World::set_joint_friction(int body, int axis, double friction) {
  const int dof = dof_of(body, axis);
  if (dof < 0) return false;
  System& s = systems_[index(movers_[index(body)].index)];
  s.system.set_friction(dof, friction);
  s.has_rows = needs_rows(s.system);
  return true;
}

double World::mobility(int body, const Eigen::Vector3d& point, const Eigen::Vector3d& n) {
  const Mover& m = movers_[index(body)];
  if (m.kind == Kind::kFixed) return 0;
  if (m.kind == Kind::kFree) return sim::mobility(motions_[index(body)], point, n);
  return n.dot(systems_[index(m.index)].system.dynamics().response(m.link, point, m.link, point) * n);
}

}  // namespace tactus::sim::impulse
