// Tests of behaviour models that another program registers.
#include <catch2/catch.hpp>
#include <stdexcept>

#include "sim_node/behaviour/mechanics.h"
#include "sim_node/behaviour/single_group.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;

namespace {

// Bodies fall at half of gravity.
class HalfWeight : public SingleGroup {
 public:
  HalfWeight(const WorldDef& world, Settings settings, Ids& ids) : SingleGroup(world, (settings.solver = "impulse", settings), ids) {}
  void tick(sync::SimTime now, std::span<const GroupTool> tools, std::vector<contact_event_t>& events) override {
    for (std::size_t i = 0; i < motions().size(); ++i)
      if (motions()[i].moves()) add_wrench(static_cast<int>(i), Eigen::Vector3d(0, 0, 0.5 * kG / motions()[i].inverse_mass_1_kg), Eigen::Vector3d::Zero());
    SingleGroup::tick(now, tools, events);
  }
};

}  // namespace

TEST_CASE("A registered behaviour model moves the bodies of a world that names it, and another name is refused") {
  register_behaviour("half_weight", {.name = {}, .impulses = true, .needs_gaps = true},
                     [](const WorldDef& world, const Settings& settings, Ids& ids) { return std::make_unique<HalfWeight>(world, settings, ids); });
  CHECK(behaviour_model("custom:half_weight").needs_gaps);
  WorldDef world = empty_world();
  const int ball = add_ball(world, 0.3, 0.02, {0, 0, 50});
  Settings settings;
  settings.solver = "custom:half_weight";
  Ids ids(1);
  const auto mechanics = make_mechanics(world, settings, ids, std::make_shared<MeshTrees>());
  std::vector<contact_event_t> events;
  mechanics->start({}, events);
  constexpr int kSteps = 1000;
  for (int n = 0; n < kSteps; ++n) mechanics->tick(sync::sim_time(std::int64_t{n} * 1'000'000), {}, events);
  const double t_s = kSteps * settings.step_s;
  // The step is exact for gravity. An added force acts as an impulse at the begin of each step, so its path is longer by one part in n.
  // Rounding: 1000 sums of order 50, 1000 * 50 * 2^-53.
  const double exact_m = 50 - 0.5 * kG * t_s * t_s + 0.25 * kG * t_s * t_s * (1 + 1.0 / kSteps);
  CHECK(mechanics->motions()[static_cast<std::size_t>(ball)].position_m.z() == Approx(exact_m).margin(6e-12).epsilon(0));
  settings.solver = "custom:other";
  CHECK_THROWS_WITH(make_mechanics(world, settings, ids, std::make_shared<MeshTrees>()), Catch::Contains("\"custom:other\" is not part of this program"));
  CHECK_THROWS_AS(register_behaviour("half_weight", {}, nullptr), std::invalid_argument);
}
