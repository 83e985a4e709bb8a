// The point proxy: the image of the hand that stays on the surface (Zilles and Salisbury 1995; Ruspini, Kolarov
// and Khatib 1997), with Coulomb friction as a cone around the normal force of the binding surfaces (after Harwin
// and Melder 2002).
//
// Friction shifts the goal: the proxy is the allowed point closest to (device + s), where the shift s points to
// the previous place of the proxy, as carried by the moving surfaces, and is at most as long as the cone is wide.
// Friction therefore never moves the proxy through a surface, and the force splits exactly into normal and
// tangential parts.
#pragma once

#include <span>

#include "haptic_node/contact/surfaces.h"

namespace tactus::haptic {

class Proxy {
 public:
  // Sets its position, without friction. Call once before step.
  void reset(const Eigen::Vector3d& device) {
    position_ = device;
    velocity_.setZero();
    shift_.setZero();
    slipping_ = false;
    touching_ = false;
  }

  // One tick: sets depth_m of every surface. Realtime-safe: yes.
  void step(std::span<Surface> surfaces, const Eigen::Vector3d& device, double dt);

  const Eigen::Vector3d& position() const { return position_; }  // m, centre of the tool
  const Eigen::Vector3d& velocity() const { return velocity_; }  // m/s, mean over the tick
  // Tangential displacement of the coupling, m: position = device + shift + sum of depth_i normal_i.
  const Eigen::Vector3d& shift() const { return shift_; }
  bool slipping() const { return slipping_; }
  // False: the surfaces have no common point, and each is pressed separately.
  bool feasible() const { return feasible_; }

 private:
  Eigen::Vector3d carried(std::span<const Surface> surfaces, double dt) const;

  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d shift_ = Eigen::Vector3d::Zero();
  bool slipping_ = false;
  bool touching_ = false;
  bool feasible_ = true;
};

}  // namespace tactus::haptic
