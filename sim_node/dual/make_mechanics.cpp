#include "sim_node/behaviour/mechanics.h"
#include "sim_node/behaviour/single_group.h"
#include "sim_node/dual/dual_groups.h"

namespace tactus::sim {

std::unique_ptr<Mechanics> make_mechanics(const WorldDef& world, const Settings& settings, Ids& ids,
                                          const std::shared_ptr<MeshTrees>& trees) {
  if (settings.groups == "dual") return std::make_unique<DualGroups>(world, settings, ids, trees);
  return std::make_unique<SingleGroup>(world, settings, ids);
}

}  // namespace tactus::sim
