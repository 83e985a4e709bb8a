#include "visual_node/scene_view/meshes.h"

namespace tactus::visual {

Meshes meshes_of(const sync::SceneReceiver& scenes) {
  Meshes meshes;
  if (!scenes.scene()) return meshes;
  for (const visual_def_t& visual : scenes.scene()->visuals) {
    const shape_def_t& shape = visual.shape;
    if (shape.kind != shape_def_t::MESH || meshes.contains(shape.mesh_hash)) continue;
    const sync::Asset* asset = scenes.asset(shape.mesh_hash);
    if (!asset) continue;
    if (auto mesh = sync::decode_asset<mesh_t>(asset->bytes)) meshes.emplace(shape.mesh_hash, std::move(*mesh));
  }
  return meshes;
}

}  // namespace tactus::visual
