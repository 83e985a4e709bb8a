// Units of a world, and their state by value.
#include <algorithm>

#include "sim_node/behaviour/impulse/world.h"

namespace tactus::sim::impulse {

int World::unit_of(int body) const {
  const Mover& m = movers_[index(body)];
  if (m.kind == Kind::kFixed) return -1;
  return m.kind == Kind::kFree ? m.index : static_cast<int>(free_.size()) + m.index;
}

int World::parent_of(int body) const {
  const Mover& m = movers_[index(body)];
  if (m.kind != Kind::kLink) return -1;
  const System& s = systems_[index(m.index)];
  const int parent = s.system.tree().links[index(m.link)].def.parent;
  return parent < 0 ? -1 : s.bodies[index(parent)];
}

void World::unit_bodies(int unit, std::vector<int>& out) const {
  if (index(unit) < free_.size()) {
    out.push_back(body_of_[index(unit)]);
  } else {
    const auto& links = systems_[index(unit) - free_.size()].bodies;
    out.insert(out.end(), links.begin(), links.end());
  }
}

void World::set_active(std::span<const int> units) {
  present_.resize(movers_.size(), 0);
  for (const int body : active_bodies_) present_[index(body)] = 0;
  active_.assign(units.begin(), units.end());
  active_bodies_.clear();
  for (const int unit : active_) unit_bodies(unit, active_bodies_);
  std::sort(active_bodies_.begin(), active_bodies_.end());
  for (const int body : active_bodies_) present_[index(body)] = 1;
  has_active_set_ = true;
}

// Units added later are active too, until set_active() is called.
void World::activate_all() {
  if (has_active_set_ || index(units()) == active_.size()) return;
  active_.resize(index(units()));
  for (std::size_t i = 0; i < active_.size(); ++i) active_[i] = static_cast<int>(i);
  set_active(std::vector<int>(active_));
  has_active_set_ = false;
}

void World::copy_state(int unit, UnitState& out) const {
  if (index(unit) < free_.size()) {
    const FreeBody& b = free_[index(unit)];
    out.body = {b.centre_m, b.orientation, velocity_for(b, 0), b.spin_rad_s};
  } else {
    out.joints = systems_[index(unit) - free_.size()].system.state();
  }
}

void World::set_state(int unit, const UnitState& state) {
  if (index(unit) < free_.size()) {
    FreeBody& b = free_[index(unit)];
    b.centre_m = state.body.centre_m;
    b.orientation = state.body.orientation;
    b.velocity_m_s = state.body.velocity_m_s;
    b.spin_rad_s = state.body.spin_rad_s;
    b.step_s = 0;
    motions_[index(body_of_[index(unit)])] = motion_of(b);
    return;
  }
  System& s = systems_[index(unit) - free_.size()];
  s.system.set_state(state.joints);
  refresh(s);
}

}  // namespace tactus::sim::impulse
