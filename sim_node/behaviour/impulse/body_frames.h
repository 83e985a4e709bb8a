// Conversion between the frames of an impulse world (centre of mass, rotation since the start) and the body frames of
// a scene.
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

  // Initial motion of every body of the scene: at rest, with its mass.
  std::vector<BodyMotion> at_start(const WorldDef& def) const;
  // moved: motion of the body in an impulse world. For moving bodies only. Real-time safe: yes.
  BodyMotion motion(int body, const BodyMotion& moved) const;
  // Converts the impact positions of a step from the frames of an impulse world to the body frames of the scene. Call
  // it once per step. Real-time safe: yes.
  void place_impacts(std::span<Manifold> solved) const;

 private:
  struct Frame {
    Eigen::Vector3d centre_in_body_m;
    Eigen::Quaterniond at_rest;  // of a link; the identity for other bodies
    // From the body's frame in the impulse world to the body frame of the scene. The impulse world's frame of a
    // static body never moves.
    Eigen::Isometry3d in_body = Eigen::Isometry3d::Identity();
  };
  std::vector<Frame> frames_;
};

}  // namespace tactus::sim::impulse
