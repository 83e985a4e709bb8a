// The start of a world for engines whose velocity is that of the middle of a step.
#pragma once

#include "sim_node/model/world_def.h"

namespace tactus::sim::test {

// Bullet and DART add a whole step of gravity before they move a body, so that their velocity is that of half a step ago. Bodies
// start with the velocity of half a step earlier, and then move on the exact parabola. Joints to the world would oppose that
// velocity, so a world that has one is unchanged.
struct EarlierWorld {
  EarlierWorld(const WorldDef& def, double step_s) : earlier(def) {
    for (const JointDef& j : def.joints)
      if (j.parent < 0 || j.child < 0) return;
    for (BodyDef& b : earlier.bodies)
      if (!b.is_static && b.gravity) b.velocity_m_s -= step_s / 2 * def.gravity_m_s2;
  }
  WorldDef earlier;
};

}  // namespace tactus::sim::test
