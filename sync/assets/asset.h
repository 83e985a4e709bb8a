// An asset of a scene: the bytes of a mesh, a picture, a shader or the scene itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <tactus/asset_ref_t.hpp>
#include <vector>

namespace tactus::sync {

using Bytes = std::vector<std::uint8_t>;

// Bytes of an asset in one ASSET_CHUNK.
inline constexpr std::size_t kChunkBytes = 1024;

struct Asset {
  std::int8_t kind = asset_ref_t::SCENE;
  std::string name{};
  Bytes bytes{};
};

}  // namespace tactus::sync
