// Reduces a world that fails to the bodies and the time that are needed for it.
#pragma once

#include <functional>

#include "tests/sim_node/support/random_worlds.h"

namespace tactus::sim::test {

// Without a body and its shapes. Worlds with joints stay as they are.
inline RandomWorld without_body(const RandomWorld& w, int body) {
  RandomWorld out = w;
  if (!w.world.joints.empty()) return out;
  out.world.bodies.erase(out.world.bodies.begin() + body);
  std::erase_if(out.world.shapes, [&](const ShapeDef& s) { return s.body == body; });
  for (ShapeDef& s : out.world.shapes) s.body -= s.body > body;
  std::erase_if(out.world.no_collision, [&](const std::pair<int, int>& p) { return p.first == body || p.second == body; });
  for (auto& [a, b] : out.world.no_collision) a -= a > body, b -= b > body;
  return out;
}

// The smallest world found that still fails: bodies are left out one by one, then the time is halved. fails(w) is true.
inline RandomWorld smaller_world(RandomWorld w, const std::function<bool(const RandomWorld&)>& fails) {
  constexpr double kShortest_s = 0.02;
  for (bool is_smaller = true; is_smaller;) {
    is_smaller = false;
    for (int i = static_cast<int>(w.world.bodies.size()) - 1; i >= 0; --i) {
      RandomWorld less = without_body(w, i);
      if (less.world.bodies.size() == w.world.bodies.size() || !fails(less)) continue;
      w = std::move(less);
      is_smaller = true;
    }
  }
  for (RandomWorld less = w; w.seconds > kShortest_s; w.seconds = less.seconds) {
    less.seconds = w.seconds / 2;
    if (!fails(less)) break;
  }
  return w;
}

}  // namespace tactus::sim::test
