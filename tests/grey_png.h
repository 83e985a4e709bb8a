// A grey picture as the bytes of a PNG file, for tests of what reads heights.
#pragma once

#include <png.h>

#include <cstdint>
#include <vector>

namespace tactus::test {

// samples: rows from the top, as pictures are stored; of 16 bits the high byte first.
inline std::vector<std::uint8_t> png_bytes(int columns, int rows, int bits,
                                           const std::vector<std::uint8_t>& samples,
                                           int type = PNG_COLOR_TYPE_GRAY) {
  std::vector<std::uint8_t> out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const auto append = [](png_structp writer, png_bytep bytes, std::size_t count) {
    auto& to = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(writer));
    to.insert(to.end(), bytes, bytes + count);
  };
  png_set_write_fn(png, &out, append, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(columns), static_cast<png_uint_32>(rows), bits, type,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const std::size_t stride = samples.size() / static_cast<std::size_t>(rows);
  for (int r = 0; r < rows; ++r) png_write_row(png, samples.data() + static_cast<std::size_t>(r) * stride);
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return out;
}

}  // namespace tactus::test
