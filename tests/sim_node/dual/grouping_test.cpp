#include "sim_node/dual/grouping.h"

#include <catch2/catch.hpp>

#include "tests/sim_node/support/adversary.h"

using namespace tactus;
using namespace tactus::sim;

namespace {

using Ints = std::vector<int>;

// Balls of 5 cm and 0.1 kg in a row along x, 0.5 m apart, at rest; a tool of 1 cm above the first.
struct Row {
  std::vector<GroupBody> bodies;
  std::vector<BodyMotion> motions;
  std::vector<double> strays;
  std::vector<std::pair<int, int>> touching;
  std::vector<GroupTool> tools{{{0, 0, 0.5}, {0, 0, 0}, 0.01}};
  GroupingLimits limits;

  explicit Row(int n) {
    for (int i = 0; i < n; ++i) {
      bodies.push_back({0.05, 10, -1});
      BodyMotion m;
      m.centre_m = {0.5 * i, 0, 0};
      m.inverse_mass_1_kg = 10;
      motions.push_back(m);
      strays.push_back(0);
    }
  }
  static sync::SimTime at(int ms) { return sync::sim_time(ms * std::int64_t{1'000'000}); }
  static Ints list(std::span<const int> s) { return {s.begin(), s.end()}; }
  void step(Grouping& g, int ms) { g.begin_step(at(ms), motions, strays, touching, tools); }
};

}  // namespace

TEST_CASE("A body enters the haptic group when the tool may reach it before the next visual step") {
  Row r(3);
  Grouping g(r.bodies, r.limits);
  r.step(g, 0);
  CHECK(g.haptic().empty());
  r.tools[0].velocity_m_s = {0, 0, -30};  // 0.51 m in 17 ms
  r.step(g, 17);
  CHECK(Row::list(g.haptic()) == Ints{0});
  CHECK(Row::list(g.entered()) == Ints{0});
  CHECK(g.is_haptic(0));
  CHECK_FALSE(g.is_haptic(1));
  r.tools[0].velocity_m_s = {0, 0, 30};
  r.step(g, 34);
  CHECK(Row::list(g.haptic()) == Ints{0});  // stays for leave_after
  CHECK(g.entered().empty());
  r.step(g, 17 + 33);
  CHECK(g.left().empty());
  r.step(g, 17 + 34);
  CHECK(Row::list(g.left()) == Ints{0});
  CHECK(g.haptic().empty());
}

TEST_CASE("Trajectories that cross at different times do not group bodies, capsules do") {
  Row r(1);
  r.limits.tool_acceleration_m_s2 = 0;
  r.limits.gravity_m_s2 = 0;
  r.motions[0].velocity_m_s = {20, 0, 0};
  r.tools[0].velocity_m_s = {0, 0, -40};
  r.tools[0].centre_m = {0.02, 0, 0.62};  // at z = 0 after 15.5 ms, when the ball is 0.3 m away
  Grouping sound(r.bodies, r.limits), kim(r.bodies, r.limits, GroupingRule::kKim2005);
  r.step(sound, 0);
  r.step(kim, 0);
  CHECK(sound.haptic().empty());
  CHECK(Row::list(kim.haptic()) == Ints{0});
}

TEST_CASE("A joint system enters as a whole with the moving bodies that touch it, but not with static ones") {
  Row r(6);
  r.bodies[0].system = r.bodies[2].system = r.bodies[3].system = 0;
  r.touching = {{3, 4}, {0, 5}};
  r.bodies[5].inverse_mass_1_kg = 0;
  r.tools[0].centre_m.z() = 0.065;
  Grouping g(r.bodies, r.limits);
  r.step(g, 0);
  CHECK(Row::list(g.haptic()) == Ints{0, 2, 3, 4});
}

TEST_CASE("A body that a struck body may strike is in the group, a third one after the next impact") {
  Row r(3);
  r.motions[1].centre_m = {0.11, 0, 0};  // a centimetre from the first
  r.motions[2].centre_m = {0.22, 0, 0};
  r.tools[0] = {{-0.07, 0, 0}, {3, 0, 0}, 0.01};
  Grouping sound(r.bodies, r.limits), kim(r.bodies, r.limits, GroupingRule::kKim2005);
  r.step(sound, 0);
  r.step(kim, 0);
  CHECK(Row::list(sound.haptic()) == Ints{0, 1});
  CHECK(Row::list(kim.haptic()) == Ints{0});
  r.motions[1].centre_m.x() += 0.004;
  r.motions[1].velocity_m_s.x() = 2;
  sound.check_pads(Row::at(2), r.motions, r.tools);
  CHECK(Row::list(sound.entered()) == Ints{2});
}

TEST_CASE("A tool that changes direction is detected in the same tick, and the group grows at once") {
  Row r(4);
  Grouping g(r.bodies, r.limits);
  r.step(g, 0);
  CHECK(g.haptic().empty());
  g.check_pads(Row::at(1), r.motions, r.tools);
  CHECK(g.pad_violations() == 0);
  r.tools[0].centre_m = {1.5, 0, 0.05};  // further than any hand can move
  g.check_pads(Row::at(2), r.motions, r.tools);
  CHECK(g.pad_violations() == 1);
  CHECK(Row::list(g.entered()) == Ints{3});
  CHECK(g.is_haptic(3));
  g.check_pads(Row::at(3), r.motions, r.tools);
  CHECK(g.pad_violations() == 1);
  CHECK(g.entered().empty());
}

TEST_CASE("Every body that the hand touches is in the group, for any motion of the hand") {
  tactus::sim::test::AdversaryResult all_sound, all_kim;
  for (const double acceleration : {0.0, 9.8, 30.0, 100.0, 300.0})
    for (unsigned seed = 1; seed <= 4; ++seed) {
      tactus::sim::test::AdversaryDef def;
      def.tool_acceleration_m_s2 = acceleration;
      def.seed = seed;
      def.room_m = seed % 2 == 0 ? 0.5 : 0.6;
      def.tool_speed_m_s = seed > 2 ? 5 : 1;
      INFO("acceleration " << acceleration << " m/s^2, seed " << seed);
      const tactus::sim::test::AdversaryResult sound = tactus::sim::test::Adversary(def, GroupingRule::kSound, {}).run();
      const tactus::sim::test::AdversaryResult kim = tactus::sim::test::Adversary(def, GroupingRule::kKim2005, {}).run();
      CHECK(sound.missed == 0);
      CHECK(sound.group < def.balls);
      all_sound.contacts += sound.contacts;
      all_kim.missed += kim.missed;
    }
  CHECK(all_sound.contacts > 500);
  CHECK(all_kim.missed > 50);  // so the comparison covers real contacts
}
