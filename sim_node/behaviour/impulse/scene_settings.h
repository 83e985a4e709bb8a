// Changes of a scene during an impulse simulation, by the scene's names and frames, for any of its worlds.
#pragma once

#include <string>
#include <vector>

#include "sim_node/behaviour/impulse/world.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim::impulse {

// Changes that hold from now on. Poses and velocities are momentary and therefore not included.
struct SceneChange {
  enum Kind { kGravity, kMass, kFriction, kRestitution, kMotor, kJointFriction };
  int kind = kGravity;
  int body = -1;
  std::string joint = {};
  int axis = 0;
  Eigen::Vector3d values = Eigen::Vector3d::Zero();

  // bodies: number of bodies in the world.
  void archive(StateArchive& a, std::size_t bodies);
};

class SceneSettings {
 public:
  // world: one of this scene.
  SceneSettings(const WorldDef& def, const World& world);

  // Returns false when the target does not exist.
  bool apply(World& world, const SceneChange& change) const;
  bool set_pose(World& world, int body, const Eigen::Isometry3d& pose) const;

 private:
  // The link that a joint moves. Seen from the other side, its axes are numbered in reverse.
  struct Joint {
    std::string name;
    int body;
    bool swapped;
  };
  const Joint* joint(const std::string& name) const;
  Surface changed(Surface surface, const SceneChange& change) const;

  std::vector<bool> has_gravity_;
  std::vector<int> body_of_;  // per shape
  std::vector<Eigen::Vector3d> centre_in_body_m_;
  std::vector<Joint> joints_;
};

}  // namespace tactus::sim::impulse
