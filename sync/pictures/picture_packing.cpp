#include "sync/pictures/picture_packing.h"

#include <algorithm>
#include <stdexcept>

#include "sync/sandbox/records.h"

namespace tactus::sync {
namespace {

[[noreturn]] void reject() { throw std::runtime_error("its reader returned no valid picture"); }

std::size_t product(int a, int b) { return static_cast<std::size_t>(a) * static_cast<std::size_t>(b); }

}  // namespace

std::vector<std::uint8_t> pack_request(PictureKind kind, std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> request{static_cast<std::uint8_t>(kind)};
  request.insert(request.end(), bytes.begin(), bytes.end());
  return request;
}

std::vector<std::uint8_t> pack(const HeightMap& map) {
  Packer to;
  to.put(map.columns), to.put(map.rows), to.put(map.white), to.put_list(map.levels);
  return to.take();
}

std::vector<std::uint8_t> pack(const Raster& raster) {
  Packer to;
  to.put(raster.width), to.put(raster.height), to.put(static_cast<std::uint8_t>(raster.translucent)), to.put_list(raster.rgba);
  return to.take();
}

HeightMap unpack_height_map(std::span<const std::uint8_t> answer) {
  Unpacker from(answer);
  HeightMap map;
  map.columns = from.get<int>(), map.rows = from.get<int>(), map.white = from.get<int>();
  const auto fits = [](int side) { return side >= kMinHeightMapSide && side <= kMaxHeightMapSide; };
  if (!fits(map.columns) || !fits(map.rows) || (map.white != 255 && map.white != 65535)) reject();
  map.levels = from.get_list<std::vector<std::uint16_t>>();
  if (!from.at_end() || map.levels.size() != product(map.columns, map.rows)) reject();
  if (std::any_of(map.levels.begin(), map.levels.end(), [&](std::uint16_t level) { return level > map.white; })) reject();
  return map;
}

Raster unpack_raster(std::span<const std::uint8_t> answer) {
  Unpacker from(answer);
  Raster raster;
  raster.width = from.get<int>(), raster.height = from.get<int>();
  const auto fits = [](int side) { return side >= 1 && side <= kMaxRasterSide; };
  if (!fits(raster.width) || !fits(raster.height)) reject();
  raster.translucent = from.get<std::uint8_t>() != 0;
  raster.rgba = from.get_list<std::vector<std::uint8_t>>();
  if (!from.at_end() || raster.rgba.size() != 4 * product(raster.width, raster.height)) reject();
  return raster;
}

}  // namespace tactus::sync
