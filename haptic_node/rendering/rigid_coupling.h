// The virtual coupling of renderings other than the point proxy: the force of each surface on a rigid tool, which
// acts where the two meet, so that all together are the wrench on the hand.
#pragma once

#include <span>

#include "haptic_node/rendering/coupling.h"
#include "haptic_node/devices/device.h"
#include "haptic_node/contact/rigid_proxy.h"
#include "haptic_node/settings.gen.h"

namespace tactus::haptic {

// Turning by an angle costs as much as moving by so much times it, m: the root of the stiffest coupling against
// turning over the stiffest against moving, each by the rules of coupling_gains, with the inertia and the damping
// of turning.
double coupling_lever_m(const Settings& settings);

// Of each surface that binds, N, into `forces`: along its normal by its depth and by the rate at which the device
// presses into it, shared among all that bind; never pulling. Along it by its grip, within the cone.
// factor: as of coupling_forces. Realtime-safe: yes.
void rigid_forces(std::span<const Surface> surfaces, const RigidProxy& proxy, const DeviceState& device,
                  double factor, std::span<Eigen::Vector3d> forces);

// The same of direct rendering, where friction is dynamic and fades with the speed over the surface.
void direct_forces(std::span<const Surface> surfaces, const DeviceState& device, double lever_m,
                   double tool_radius_m, double factor, std::span<Eigen::Vector3d> forces);

// Changes forces at those arms as little as can be, the large ones most, so that together they are `felt`: exactly
// the force, and the torque as far as the places allow without couples of forces larger than most_N: places that lie
// nearly on a line would need them.
void share_wrench(const Wrench& felt, std::span<const Eigen::Vector3d> arms, std::span<Eigen::Vector3d> forces,
                  double most_N);

}  // namespace tactus::haptic
