// What of a scene may be set while impulses move it, by its names and frames, in any of the worlds that move it.
#pragma once

#include <string>
#include <vector>

#include "sim_node/behaviour/impulse/world.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim::impulse {

// What holds for a scene from now on; poses and velocities are of the moment, and not here.
struct SceneChange {
  enum Kind { kGravity, kMass, kFriction, kRestitution, kMotor, kJointFriction };
  int kind = kGravity;
  int body = -1;
  std::string joint = {};
  int axis = 0;
  Eigen::Vector3d values = Eigen::Vector3d::Zero();

  // bodies: how many the world has.
  void archive(StateArchive& a, std::size_t bodies);
};

class SceneSettings {
 public:
  // world: one of this scene.
  SceneSettings(const WorldDef& def, const World& world);

  // False: there is no such thing.
  bool apply(World& world, const SceneChange& change) const;
  bool set_pose(World& world, int body, const Eigen::Isometry3d& pose) const;

 private:
  // The link that a joint carries; from the other side its axes are numbered the other way round.
  struct Joint {
    std::string name;
    int body;
    bool swapped;
  };
  const Joint* joint(const std::string& name) const;
  Surface changed(Surface surface, const SceneChange& change) const;

  std::vector<bool> falls_;
  std::vector<int> body_of_;  // per shape
  std::vector<Eigen::Vector3d> centre_in_body_m_;
  std::vector<Joint> joints_;
};

}  // namespace tactus::sim::impulse
