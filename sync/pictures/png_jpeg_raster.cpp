#include "sync/pictures/picture_decoders.h"

#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <stdexcept>
#include <string>

#include <jpeglib.h>

namespace tactus::sync {
namespace {

constexpr unsigned kMaxSide = kMaxRasterSide;

void check_size(unsigned width, unsigned height) {
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
    throw std::runtime_error("it must have 1 to " + std::to_string(kMaxSide) + " pixels per side");
}

Raster sized(unsigned width, unsigned height) {
  check_size(width, height);
  Raster r;
  r.width = static_cast<int>(width), r.height = static_cast<int>(height);
  r.rgba.resize(std::size_t{4} * width * height);
  return r;
}

Raster read_png(std::span<const std::uint8_t> bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  struct Freed {
    png_image& image;
    ~Freed() { png_image_free(&image); }
  } freed{image};
  if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()))
    throw std::runtime_error("its PNG is damaged: " + std::string(image.message));
  Raster r = sized(image.width, image.height);
  image.format = PNG_FORMAT_RGBA;
  const auto stride = static_cast<png_int_32>(4 * image.width);
  if (!png_image_finish_read(&image, nullptr, r.rgba.data(), -stride, nullptr))  // negative: the lowest row first
    throw std::runtime_error("its PNG is damaged: " + std::string(image.message));
  for (std::size_t i = 3; i < r.rgba.size() && !r.translucent; i += 4) r.translucent = r.rgba[i] < 255;
  return r;
}

struct JpegErrors : jpeg_error_mgr {
  std::jmp_buf back;
  char message[JMSG_LENGTH_MAX] = "";
};

void on_error(j_common_ptr jpeg) {
  auto* errors = static_cast<JpegErrors*>(jpeg->err);
  (*errors->format_message)(jpeg, errors->message);
  std::longjmp(errors->back, 1);
}

// Below 0: missing or invalid bytes, which libjpeg would fill with grey.
void on_message(j_common_ptr jpeg, int level) {
  if (level < 0) on_error(jpeg);
}

Raster read_jpeg(std::span<const std::uint8_t> bytes) {
  Raster r;
  JpegErrors errors;
  jpeg_decompress_struct jpeg{};
  jpeg.err = jpeg_std_error(&errors);
  errors.error_exit = on_error;
  errors.emit_message = on_message;
  // libjpeg reports errors by a jump over its C frames; no object with a destructor is created in between.
  if (setjmp(errors.back)) {
    jpeg_destroy_decompress(&jpeg);
    throw std::runtime_error("its JPEG is damaged: " + std::string(errors.message));
  }
  jpeg_create_decompress(&jpeg);
  jpeg_mem_src(&jpeg, bytes.data(), bytes.size());
  jpeg_read_header(&jpeg, TRUE);
  if (jpeg.image_width > kMaxSide || jpeg.image_height > kMaxSide) {
    jpeg_destroy_decompress(&jpeg);
    check_size(kMaxSide + 1, 1);
  }
  jpeg.out_color_space = JCS_EXT_RGBA;
  jpeg_start_decompress(&jpeg);
  r.width = static_cast<int>(jpeg.output_width), r.height = static_cast<int>(jpeg.output_height);
  r.rgba.resize(std::size_t{4} * jpeg.output_width * jpeg.output_height);
  while (jpeg.output_scanline < jpeg.output_height) {
    JSAMPROW row =
        r.rgba.data() + std::size_t{4} * jpeg.output_width * (jpeg.output_height - 1 - jpeg.output_scanline);
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_decompress(&jpeg);
  jpeg_destroy_decompress(&jpeg);
  return r;
}

}  // namespace

Raster read_raster(std::span<const std::uint8_t> bytes) {
  if (bytes.size() >= 8 && png_sig_cmp(bytes.data(), 0, 8) == 0) return read_png(bytes);
  if (bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff) return read_jpeg(bytes);
  throw std::runtime_error("it is neither a PNG nor a JPEG file");
}

}  // namespace tactus::sync
