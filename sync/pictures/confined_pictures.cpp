#include "sync/pictures/confined_pictures.h"

#include "sync/pictures/picture_packing.h"

namespace tactus::sync {

ConfinedPictures::ConfinedPictures() : session_("read_pictures", {}) {}

HeightMap ConfinedPictures::height_map(std::span<const std::uint8_t> png) {
  return unpack_height_map(session_.request(pack_request(PictureKind::kHeightMap, png)));
}

Raster ConfinedPictures::raster(std::span<const std::uint8_t> bytes) {
  return unpack_raster(session_.request(pack_request(PictureKind::kRaster, bytes)));
}

}  // namespace tactus::sync
