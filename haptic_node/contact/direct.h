// Direct rendering: no proxy, each surface pushes the tool at the device itself, by how deep it is under it.
// Without memory: what is thin is passed through, and the surface that is nearest is the one that pushes, as in
// the first haptic displays (Zilles and Salisbury 1995 say what is wrong with it); for comparison, and where
// nothing else settles.
#pragma once

#include <span>

#include "haptic_node/contact/surfaces.h"

namespace tactus::haptic {

struct DevicePose;

// Sets depth_m of every surface: how deep the device's tool lies under it. Surfaces that push the same way share:
// together they are as stiff as one. Forgets all friction. placed: the pose for which the surfaces' offsets hold.
// lever_m: as of RigidProxy. Realtime-safe: yes.
void press_directly(std::span<Surface> surfaces, const DevicePose& placed, const DevicePose& device,
                    double lever_m, double tool_radius_m);

}  // namespace tactus::haptic
