// From what an impulse world moves, centres of mass and the turns of links since the start, to the frames of the bodies
// of a scene, and back.
#pragma once

#include <span>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/model/manifold.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim::impulse {

class BodyFrames {
 public:
  explicit BodyFrames(const WorldDef& def);

  // Of every body as the scene has it: at rest, with its mass.
  std::vector<BodyMotion> at_start(const WorldDef& def) const;
  // moved: of an impulse world. Of a body that moves. Realtime-safe: yes.
  BodyMotion motion(int body, const BodyMotion& moved) const;
  // Where surfaces met in a step, in the frames of the bodies of the scene; as an impulse world has it before, once only.
  // Realtime-safe: yes.
  void place_impacts(std::span<Manifold> solved) const;

 private:
  struct Frame {
    Eigen::Vector3d centre_in_body_m;
    Eigen::Quaterniond at_rest;  // of a link; else the identity
    // From the frame that an impulse world has for it, which never moves for what does not.
    Eigen::Isometry3d in_body = Eigen::Isometry3d::Identity();
  };
  std::vector<Frame> frames_;
};

}  // namespace tactus::sim::impulse
