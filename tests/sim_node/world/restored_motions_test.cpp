#include <catch2/catch.hpp>
#include <cstring>
#include <span>

#include "sim_node/model/archive_motion.h"
#include "sim_node/model/envelope.h"
#include "sim_node/world/simulation.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus::sim;
using namespace tactus::sim::test;

using Bytes = std::vector<std::uint8_t>;

TEST_CASE("The motions of a restored state are within their ranges, with every contact law") {
  const std::string solver = GENERATE("impulse", "penalty", "quick");
  CAPTURE(solver);
  WorldDef w = empty_world();
  add_floor(w);
  for (int i = 0; i < 3; ++i) add_box(w, 0.2, {0.1, 0.1, 0.1}, at(0, 0, 0.051 + 0.102 * i), 0.6, 0.2);
  Settings settings;
  settings.solver = solver;
  Simulation s(w, settings);
  s.start(11);
  for (int i = 0; i < 20; ++i) s.step({});
  const Bytes now = s.save();
  std::uint64_t fingerprint = 0;
  std::memcpy(&fingerprint, now.data() + 16, sizeof fingerprint);
  const std::span<const std::uint8_t> state = unwrap_state(now, fingerprint);
  int accepted = 0, refused = 0;
  for (std::size_t word = 0; word + 8 <= state.size(); word += 8)
    for (const double value : {1e100, -1e14, 1e10}) {
      Bytes changed(state.begin(), state.end());
      std::memcpy(changed.data() + word, &value, sizeof value);
      const bool valid = s.restore(wrap_state(changed, fingerprint)).empty();
      valid ? ++accepted : ++refused;
      if (!valid) continue;
      CAPTURE(word, value);
      for (const BodyMotion& b : s.bodies()) REQUIRE(plausible(b));
      REQUIRE(s.restore(now) == "");
    }
  CHECK(accepted > 0);
  CHECK(refused > 100);
}
