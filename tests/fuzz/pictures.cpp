// Arbitrary bytes read as a picture of a surface and as a height map: rejected, or as many pixels as width and height give.
#include <cstdlib>
#include <stdexcept>

#include "sync/pictures/picture_decoders.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto raster = tactus::sync::read_raster({data, size});
    if (raster.width < 1 || raster.height < 1 ||
        raster.rgba.size() != 4u * static_cast<unsigned>(raster.width * raster.height))
      std::abort();
  } catch (const std::runtime_error&) {
  }
  try {
    const auto map = tactus::sync::read_height_map({data, size});
    if (map.columns < 1 || map.rows < 1 ||
        map.levels.size() != static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows))
      std::abort();
    for (const std::uint16_t level : map.levels)
      if (level > map.white) std::abort();
  } catch (const std::runtime_error&) {
  }
  return 0;
}
