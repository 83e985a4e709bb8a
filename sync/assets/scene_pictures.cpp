#include "sync/assets/scene_pictures.h"

#include <tactus/material_def_t.hpp>

namespace tactus::sync {

Pictures pictures_of(const SceneReceiver& scenes) {
  Pictures pictures;
  if (!scenes.scene()) return pictures;
  for (const material_def_t& m : scenes.scene()->materials)
    for (const std::int64_t hash : {m.bump_asset, m.friction_asset})  // 0: none
      if (const Asset* asset = hash != 0 && !pictures.contains(hash) ? scenes.asset(hash) : nullptr)
        pictures.emplace(hash, asset->bytes);
  return pictures;
}

}  // namespace tactus::sync
