#include "visual_node/overlay/body_groups.h"

#include <catch2/catch.hpp>
#include <tactus/body_state_t.hpp>
#include <tactus/world_state_t.hpp>

using namespace tactus;
using namespace tactus::visual;

namespace {

world_state_t state(int body, std::int8_t group, std::int64_t seq, std::int64_t incarnation = 1) {
  world_state_t m{};
  m.header.seq = seq, m.header.incarnation = incarnation;
  m.group = group;
  body_state_t b{};
  b.body = body;
  m.bodies.push_back(b);
  m.count = 1;
  return m;
}

}  // namespace

TEST_CASE("A body is in its last published group, also if messages are reordered") {
  BodyGroups groups;
  groups.push(state(1, world_state_t::NOW, 5));
  groups.push(state(2, world_state_t::AHEAD, 6));
  const auto tints = groups.tints(4);
  REQUIRE(tints.size() == 4);
  CHECK(tints[0].w() == 0);
  CHECK(tints[1].w() > 0);
  CHECK(tints[2].w() > 0);
  CHECK(tints[1] != tints[2]);
  groups.push(state(2, world_state_t::PROMOTED, 8));
  groups.push(state(2, world_state_t::AHEAD, 7));
  CHECK(groups.tints(4)[2] == tints[1]);
  CHECK(groups.haptic() == 2);
  CHECK(groups.visual() == 0);
}

TEST_CASE("A new incarnation of the simulation clears the groups, and invalid bodies are ignored") {
  BodyGroups groups;
  groups.push(state(1, world_state_t::NOW, 500));
  groups.push(state(3, world_state_t::AHEAD, 1, 2));
  CHECK(groups.haptic() == 0);
  CHECK(groups.visual() == 1);
  groups.push(state(BodyGroups::kMaxBodies, world_state_t::NOW, 2, 2));
  groups.push(state(-1, world_state_t::NOW, 3, 2));
  CHECK(groups.haptic() == 0);
  CHECK(groups.tints(2).size() == 2);  // fewer bodies than it has received
}
