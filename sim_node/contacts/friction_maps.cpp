#include "sim_node/contacts/friction_maps.h"

#include <map>
#include <tactus/material_def_t.hpp>

#include "sync/bus/identity.h"
#include "sync/pictures/confined_pictures.h"

namespace tactus::sim {

FrictionMaps::FrictionMaps(const WorldDef& world) {
  std::map<int, std::shared_ptr<const FrictionMap>> of_material;
  sync::ConfinedPictures pictures;
  for (std::size_t i = 0; i < world.materials.size(); ++i) {
    const material_def_t& m = world.materials[i];
    if (m.friction_asset == 0) continue;
    for (const sync::Asset& image : world.images)
      if (sync::fnv1a_64(image.bytes.data(), image.bytes.size()) == m.friction_asset)
        of_material[static_cast<int>(i)] = std::make_shared<const FrictionMap>(pictures.height_map(image.bytes), m);
  }
  for (const ShapeDef& s : world.shapes) {
    const auto map = of_material.find(s.material);
    shapes_.push_back({map == of_material.end() ? nullptr : map->second, s.pose});
    any_ = any_ || shapes_.back().map;
  }
}

void FrictionMaps::apply(const Eigen::Isometry3d& to_a, const Eigen::Isometry3d& to_b, Manifold& contact) const {
  const auto& a = shapes_[static_cast<std::size_t>(contact.shape_a)].map;
  const auto& b = shapes_[static_cast<std::size_t>(contact.shape_b)].map;
  for (ManifoldPoint& p : contact.used()) {
    p.friction = 1;
    if (a) p.friction *= pair_factor(a->factor(to_a.linear() * p.normal, to_a * p.point_m));
    if (b) p.friction *= pair_factor(b->factor(to_b.linear() * -p.normal, to_b * p.point_m));
  }
}

}  // namespace tactus::sim
