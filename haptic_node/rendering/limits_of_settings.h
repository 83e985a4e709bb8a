// The limits of the parts of a renderer, from its settings. Pure.
#pragma once

#include <algorithm>

#include "haptic_node/contact/reliefs.h"
#include "haptic_node/contact/surfaces.h"
#include "haptic_node/rendering/coupling.h"
#include "haptic_node/rendering/transient.h"
#include "haptic_node/safety/injected_energy.h"
#include "haptic_node/safety/passivity.h"
#include "haptic_node/safety/wall_energy.h"
#include "haptic_node/settings.gen.h"

namespace tactus::haptic {

SurfaceLimits surface_limits(const Settings& s);
CouplingLimits coupling_limits(const Settings& s);
ReliefDef reliefs_of(const Settings& s);
// The simulation holds the mean force of a tick for as long as the next tick, if ticks are longer than its steps, s.
inline double hold_of_push_s(double rate_Hz, double step_s) { return std::max(0.0, 1 / rate_Hz - step_s); }
// step_s: of the simulation.
PassivityLimits passivity_limits(const Settings& s, double step_s);
WallLimits wall_limits(const Settings& s);
InjectedLimits injected_limits(const Settings& s);
TransientShape transient_shape(const Settings& s);

}  // namespace tactus::haptic
