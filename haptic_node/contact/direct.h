// Direct rendering, without a proxy: each surface pushes the tool in proportion to the depth of the device below
// it. It has no memory: the tool passes through thin objects and the nearest surface pushes, as in the first
// haptic displays (Zilles and Salisbury 1995 describe the drawbacks). For comparison, and as the fallback when the
// surfaces leave no feasible pose.
#pragma once

#include <span>

#include "haptic_node/contact/surfaces.h"

namespace tactus::haptic {

struct DevicePose;

// Sets depth_m of every surface: the depth of the tool below it, with the tool at the pose of the device. Surfaces
// that push in the same direction share the load: together they are as stiff as one. Clears all friction. placed:
// the pose for which the offsets of the surfaces hold. lever_m: as in RigidProxy. Realtime-safe: yes.
void compute_direct_depths(std::span<Surface> surfaces, const DevicePose& placed, const DevicePose& device,
                           double lever_m, double tool_radius_m);

}  // namespace tactus::haptic
