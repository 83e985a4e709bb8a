#include "sync/pictures/picture_decoders.h"

#include <png.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace tactus::sync {
namespace {

constexpr png_uint_32 kMin = kMinHeightMapSide, kMax = kMaxHeightMapSide;

[[noreturn]] void on_error(png_structp, png_const_charp message) { throw std::runtime_error(message); }
void on_warning(png_structp, png_const_charp) {}

struct Reader {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, on_error, on_warning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void on_read(png_structp png, png_bytep to, std::size_t count) {
  auto& left = *static_cast<std::span<const std::uint8_t>*>(png_get_io_ptr(png));
  if (count > left.size()) throw std::runtime_error("it is truncated");
  std::copy_n(left.begin(), count, to);
  left = left.subspan(count);
}

}  // namespace

HeightMap read_height_map(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 8 || png_sig_cmp(bytes.data(), 0, 8) != 0) throw std::runtime_error("it is not a PNG file");
  Reader reader;
  if (!reader.info) throw std::runtime_error("libpng cannot start");
  png_set_read_fn(reader.png, &bytes, on_read);
  png_read_info(reader.png, reader.info);
  const png_uint_32 columns = png_get_image_width(reader.png, reader.info);
  const png_uint_32 rows = png_get_image_height(reader.png, reader.info);
  const int bits = png_get_bit_depth(reader.png, reader.info);
  if (png_get_color_type(reader.png, reader.info) != PNG_COLOR_TYPE_GRAY || (bits != 8 && bits != 16))
    throw std::runtime_error("it must be grey with 8 or 16 bits, without alpha or palette");
  if (columns < kMin || rows < kMin || columns > kMax || rows > kMax)
    throw std::runtime_error("it must have 2 to " + std::to_string(kMax) + " samples per side");
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);

  const std::size_t stride = png_get_rowbytes(reader.png, reader.info);
  std::vector<unsigned char> pixels(stride * rows);
  std::vector<png_bytep> lines(rows);
  for (png_uint_32 r = 0; r < rows; ++r) lines[r] = pixels.data() + r * stride;
  png_read_image(reader.png, lines.data());

  HeightMap map;
  map.columns = static_cast<int>(columns), map.rows = static_cast<int>(rows);
  map.white = bits == 16 ? 65535 : 255;
  map.levels.reserve(std::size_t{columns} * rows);
  for (png_uint_32 r = rows; r-- > 0;)
    for (png_uint_32 c = 0; c < columns; ++c) {
      const unsigned char* p = lines[r] + c * (bits == 16 ? 2 : 1);
      map.levels.push_back(static_cast<std::uint16_t>(bits == 16 ? p[0] * 256 + p[1] : p[0]));
    }
  return map;
}

}  // namespace tactus::sync
