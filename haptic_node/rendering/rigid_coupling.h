// The virtual coupling of a rigid tool. The force of each surface acts at the contact point; together they give
// the wrench on the hand. Used by the renderings other than the point proxy.
#pragma once

#include <span>

#include "haptic_node/rendering/coupling.h"
#include "haptic_node/devices/device.h"
#include "haptic_node/contact/rigid_proxy.h"
#include "haptic_node/settings.gen.h"

namespace tactus::haptic {

// Lever that relates rotation to translation, m: a rotation by an angle costs as much as a translation of lever
// times angle. It is the square root of the largest rotational over the largest translational stiffness, each from
// coupling_gains; the rotational one uses the inertia and the damping of rotation.
double coupling_lever_m(const Settings& settings);
// Largest translational stiffness, N/m, whose rotational counterpart (times lever^2) is passive with this period of the
// hold and this delay of the device, as in coupling_gains.
double turning_limit_N_m(const Settings& settings, double lever_m, double period_s, double device_delay_s);

// Computes the force of each binding surface, N, into `forces`. Normal part: from the depth and from the rate at
// which the device presses into the surface, shared among all binding surfaces; it never pulls. Tangential part:
// from the grip of the surface, within the friction cone. factors: as in coupling_forces. Realtime-safe: yes.
void rigid_forces(std::span<const Surface> surfaces, const RigidProxy& proxy, const DeviceState& device,
                  const CouplingFactors& factors, std::span<Eigen::Vector3d> forces);

// Like rigid_forces, but for direct rendering: friction is dynamic and vanishes with the speed over the surface.
void direct_forces(std::span<const Surface> surfaces, const DeviceState& device, double lever_m,
                   double tool_radius_m, const CouplingFactors& factors, std::span<Eigen::Vector3d> forces);

// Changes the forces at those arms as little as possible, large forces most, so that their sum is `felt`. The
// force is exact. The torque is exact as far as the contact points allow without force couples larger than
// max_couple_N; points that lie almost on a line would need larger ones.
void share_wrench(const Wrench& felt, std::span<const Eigen::Vector3d> arms, std::span<Eigen::Vector3d> forces,
                  double max_couple_N);

}  // namespace tactus::haptic
