#include "sim_node/scene/height_image.h"

#include <png.h>

#include <cstdio>
#include <memory>
#include <stdexcept>

namespace tactus::sim {
namespace {

// A heightfield of more samples a side costs more memory than a scene should.
constexpr png_uint_32 kMaxSide = 4097;

[[noreturn]] void on_error(png_structp, png_const_charp message) { throw std::runtime_error(message); }
void on_warning(png_structp, png_const_charp) {}

struct Reader {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, on_error, on_warning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

}  // namespace

Heightfield read_height_image(const std::filesystem::path& file, const Eigen::Vector3d& size_m,
                              const Eigen::Vector3d& centre_m) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"), &std::fclose);
  unsigned char signature[8] = {};
  if (!in || std::fread(signature, 1, 8, in.get()) != 8 || png_sig_cmp(signature, 0, 8) != 0)
    throw std::runtime_error("it is no PNG file");
  Reader reader;
  if (!reader.info) throw std::runtime_error("libpng cannot be started");
  png_init_io(reader.png, in.get());
  png_set_sig_bytes(reader.png, 8);
  png_read_info(reader.png, reader.info);
  const png_uint_32 columns = png_get_image_width(reader.png, reader.info);
  const png_uint_32 rows = png_get_image_height(reader.png, reader.info);
  const int bits = png_get_bit_depth(reader.png, reader.info);
  if (png_get_color_type(reader.png, reader.info) != PNG_COLOR_TYPE_GRAY || (bits != 8 && bits != 16))
    throw std::runtime_error("it must be grey with 8 or 16 bits, without alpha or palette");
  if (columns < 2 || rows < 2 || columns > kMaxSide || rows > kMaxSide)
    throw std::runtime_error("it must have 2 to " + std::to_string(kMaxSide) + " samples a side");
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);

  const std::size_t stride = png_get_rowbytes(reader.png, reader.info);
  std::vector<unsigned char> pixels(stride * rows);
  std::vector<png_bytep> lines(rows);
  for (png_uint_32 r = 0; r < rows; ++r) lines[r] = pixels.data() + r * stride;
  png_read_image(reader.png, lines.data());

  Heightfield field;
  field.columns = static_cast<int>(columns), field.rows = static_cast<int>(rows);
  field.size_m = size_m, field.centre_m = centre_m;
  field.heights_m.reserve(std::size_t{columns} * rows);
  for (png_uint_32 r = rows; r-- > 0;)
    for (png_uint_32 c = 0; c < columns; ++c) {
      const unsigned char* p = lines[r] + c * (bits == 16 ? 2 : 1);
      const double value = bits == 16 ? (p[0] * 256 + p[1]) / 65535.0 : p[0] / 255.0;
      field.heights_m.push_back(value * size_m.z());
    }
  return field;
}

}  // namespace tactus::sim
