#include "sim_node/behaviour/impulse/scene_settings.h"

#include <algorithm>

#include "sim_node/model/index.h"

namespace tactus::sim::impulse {
namespace {

int axis_of(bool swapped, int axis) { return swapped ? 1 - axis : axis; }

}  // namespace

SceneSettings::SceneSettings(const WorldDef& def, const World& world) {
  for (const BodyDef& b : def.bodies) {
    has_gravity_.push_back(b.gravity);
    centre_in_body_m_.push_back(b.centre_of_mass_m);
  }
  for (const ShapeDef& s : def.shapes) body_of_.push_back(s.body);
  const auto moves = [&](int body) { return body >= 0 && world.moves(body); };
  for (const JointDef& j : def.joints) {
    if (!moves(j.parent) && !moves(j.child)) continue;
    const bool reversed = !moves(j.child) || (moves(j.parent) && world.parent_of(j.child) != j.parent);
    joints_.push_back({j.name, reversed ? j.parent : j.child, reversed && j.kind == JointKind::kUniversal});
  }
}

bool SceneSettings::set_pose(World& world, int body, const Eigen::Isometry3d& pose) const {
  return world.set_pose(body, pose * centre_in_body_m_[index(body)],
                        Eigen::Quaterniond(pose.linear()).normalized());
}

const SceneSettings::Joint* SceneSettings::joint(const std::string& name) const {
  const auto found = std::find_if(joints_.begin(), joints_.end(), [&](const Joint& j) { return j.name == name; });
  return found == joints_.end() ? nullptr : &*found;
}

Surface SceneSettings::changed(Surface surface, const SceneChange& change) const {
  (change.kind == SceneChange::kFriction ? surface.friction : surface.restitution) = change.values.x();
  return surface;
}

bool SceneSettings::apply(World& world, const SceneChange& c) const {
  const Joint* j = joint(c.joint);
  switch (c.kind) {
    case SceneChange::kGravity:
      for (std::size_t body = 0; body < has_gravity_.size(); ++body)
        if (has_gravity_[body] && world.moves(static_cast<int>(body)))
          world.set_gravity(static_cast<int>(body), c.values);
      return true;
    case SceneChange::kMass: return world.set_mass(c.body, c.values.x());
    case SceneChange::kFriction:
    case SceneChange::kRestitution:
      for (int shape = 0; shape < static_cast<int>(body_of_.size()); ++shape)
        if (body_of_[index(shape)] == c.body) world.set_surface(shape, changed(world.surface(shape), c));
      return true;
    case SceneChange::kMotor:
      return j && world.set_motor(j->body, axis_of(j->swapped, c.axis), c.values.x(), c.values.y());
    case SceneChange::kJointFriction:
      return j && world.set_joint_friction(j->body, axis_of(j->swapped, c.axis), c.values.x());
    default: return false;
  }
}

void SceneChange::archive(StateArchive& a, std::size_t bodies) {
  a(kind), a.index(body, bodies), a(joint), a(axis), a(values);
  a.require(kind >= kGravity && kind <= kJointFriction && (axis == 0 || axis == 1),
            "the state holds a number out of range");
}

}  // namespace tactus::sim::impulse
