// A sim_node with a behaviour model of its own: solver = custom:drag. Bodies collide as with the solver impulse, and a medium slows them.
//
//    sim_with_drag SCENE.sdf --set solver=custom:drag
#include <memory>

#include "sim_node/behaviour/single_group.h"
#include "sim_node/run.h"

namespace {

using namespace tactus;

constexpr double kSlowing_s = 0.5;  // time in which a free body loses 63 % of its speed

sim::Settings with_impulses(sim::Settings settings) {
  settings.solver = "impulse";
  return settings;
}

class Drag : public sim::SingleGroup {
 public:
  Drag(const sim::WorldDef& world, const sim::Settings& settings, sim::Ids& ids) : SingleGroup(world, with_impulses(settings), ids) {}

  void tick(sync::SimTime now, std::span<const sim::GroupTool> tools, std::vector<contact_event_t>& events) override {
    const std::span<const sim::BodyMotion> bodies = motions();
    for (std::size_t i = 0; i < bodies.size(); ++i)
      if (bodies[i].moves())
        add_wrench(static_cast<int>(i), -bodies[i].velocity_m_s / (bodies[i].inverse_mass_1_kg * kSlowing_s), Eigen::Vector3d::Zero());
    SingleGroup::tick(now, tools, events);
  }
};

}  // namespace

int main(int argc, char** argv) {
  sim::register_behaviour("drag", {.impulses = true, .needs_gaps = true, .needs_trees = true},
                          [](const sim::WorldDef& world, const sim::Settings& settings, sim::Ids& ids) { return std::make_unique<Drag>(world, settings, ids); });
  return sim::run(argc, argv);
}
