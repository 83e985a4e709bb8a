#include "sim_node/behaviour/mechanics.h"

#include <map>
#include <stdexcept>
#include <utility>

#include "sim_node/behaviour/single_group.h"
#include "sim_node/dual/dual_groups.h"

namespace tactus::sim {
namespace {

// Written before run() only, by the main function of a program that links this library.
std::map<std::string, MechanicsFactory, std::less<>>& registered_mechanics() {
  static std::map<std::string, MechanicsFactory, std::less<>> all;
  return all;
}

}  // namespace

void register_behaviour(const std::string& name, const BehaviourModel& model, MechanicsFactory make) {
  if (name.empty()) throw std::invalid_argument("sim_node: a behaviour model has no name; give it one");
  register_behaviour_model("custom:" + name, model);
  registered_mechanics().emplace("custom:" + name, std::move(make));
}

std::unique_ptr<Mechanics> make_mechanics(const WorldDef& world, const Settings& settings, Ids& ids,
                                          const std::shared_ptr<MeshTrees>& trees) {
  if (settings.groups == "dual") return std::make_unique<DualGroups>(world, settings, ids, trees);
  if (const auto i = registered_mechanics().find(settings.solver); i != registered_mechanics().end()) return i->second(world, settings, ids);
  return std::make_unique<SingleGroup>(world, settings, ids);
}

}  // namespace tactus::sim
