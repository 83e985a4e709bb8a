#include "visual_node/scene_view/meshes.h"

#include <tactus/mesh_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/visual_def_t.hpp>

#include "sync/bus/decode.h"

namespace tactus::visual {

Meshes meshes_of(const sync::SceneReceiver& scenes) {
  Meshes meshes;
  if (!scenes.scene()) return meshes;
  const auto take = [&](std::int64_t hash) {
    if (meshes.contains(hash)) return;
    const sync::Asset* asset = scenes.asset(hash);
    if (!asset) return;
    if (auto mesh = sync::decode_asset<mesh_t>(asset->bytes)) meshes.emplace(hash, std::move(*mesh));
  };
  for (const visual_def_t& visual : scenes.scene()->visuals)
    if (visual.shape.kind == shape_def_t::MESH) take(visual.shape.mesh_hash);
  for (const tool_def_t& tool : scenes.scene()->tools)
    if (tool.shape == tool_def_t::MESH) take(tool.mesh_hash);
  return meshes;
}

}  // namespace tactus::visual
