// Decodes pictures in a confined process, the program read_pictures (sync/sandbox/README.md). Pictures come from untrusted
// files, and over the bus.
#pragma once

#include <cstdint>
#include <span>

#include "lcmtypes/height_map.h"
#include "sync/pictures/raster.h"
#include "sync/sandbox/reader_session.h"

namespace tactus::sync {

class ConfinedPictures {
 public:
  // The process starts with the first picture, in about 5 ms, and ends with this object.
  ConfinedPictures();

  // The same as the functions of picture_decoders.h, bit by bit, for a picture that may be hostile. Throw std::runtime_error with
  // one clause. Not for a real-time thread; one thread only.
  HeightMap height_map(std::span<const std::uint8_t> png);
  Raster raster(std::span<const std::uint8_t> bytes);

 private:
  ReaderSession session_;
};

}  // namespace tactus::sync
