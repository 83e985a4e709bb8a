#include "visual_node/video/jpeg.h"

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>

extern "C" {
#include <jpeglib.h>
}

namespace tactus::visual {
namespace {

// libjpeg ends the process on an error unless its error handler is replaced; its warnings are discarded.
struct Errors {
  jpeg_error_mgr manager;
  std::jmp_buf back;
};
void jump(j_common_ptr info) { std::longjmp(reinterpret_cast<Errors*>(info->err)->back, 1); }
void keep_silent(j_common_ptr) {}

// RGB, the highest row first.
std::vector<std::uint8_t> shrunk(std::span<const std::uint8_t> rgba, int from_width, int from_height, int width,
                                 int height) {
  std::vector<std::uint8_t> rgb(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  std::size_t to = 0;
  for (int y = 0; y < height; ++y) {
    const int top = y * from_height / height, bottom = std::max(top + 1, (y + 1) * from_height / height);
    for (int x = 0; x < width; ++x) {
      const int left = x * from_width / width, right = std::max(left + 1, (x + 1) * from_width / width);
      unsigned sum[3] = {};
      for (int row = top; row < bottom; ++row)
        for (int column = left; column < right; ++column) {
          const auto at = (static_cast<std::size_t>(from_height - 1 - row) * static_cast<std::size_t>(from_width) +
                           static_cast<std::size_t>(column)) *
                          4;
          for (std::size_t c = 0; c < 3; ++c) sum[c] += rgba[at + c];
        }
      const auto pixels = static_cast<unsigned>((bottom - top) * (right - left));
      for (const unsigned s : sum) rgb[to++] = static_cast<std::uint8_t>((s + pixels / 2) / pixels);
    }
  }
  return rgb;
}

// No object with a destructor lives here: an error jumps out of this function.
bool compress(const std::uint8_t* rgb, int width, int height, int quality, unsigned char** out,
              unsigned long* size) {
  jpeg_compress_struct info;
  Errors errors;
  info.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = jump;
  errors.manager.output_message = keep_silent;
  if (setjmp(errors.back)) {
    jpeg_destroy_compress(&info);
    return false;
  }
  jpeg_create_compress(&info);
  jpeg_mem_dest(&info, out, size);
  info.image_width = static_cast<JDIMENSION>(width);
  info.image_height = static_cast<JDIMENSION>(height);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    JSAMPROW row = const_cast<JSAMPROW>(rgb + static_cast<std::size_t>(info.next_scanline) *
                                                  static_cast<std::size_t>(width) * 3);
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  return true;
}

}  // namespace

Jpeg encode_jpeg(std::span<const std::uint8_t> rgba, int picture_width, int picture_height, int width,
                 int quality) {
  const auto bytes = static_cast<std::size_t>(std::max(0, picture_width)) *
                     static_cast<std::size_t>(std::max(0, picture_height)) * 4;
  if (bytes == 0 || rgba.size() < bytes || width < 1) return {};
  Jpeg jpeg;
  jpeg.width = std::min(width, picture_width);
  jpeg.height =
      std::max(1, static_cast<int>((static_cast<std::int64_t>(picture_height) * jpeg.width + picture_width / 2) /
                                   picture_width));
  const std::vector<std::uint8_t> rgb = shrunk(rgba, picture_width, picture_height, jpeg.width, jpeg.height);
  unsigned char* out = nullptr;
  unsigned long size = 0;
  const bool done = compress(rgb.data(), jpeg.width, jpeg.height, std::clamp(quality, 1, 100), &out, &size);
  if (done) jpeg.bytes.assign(out, out + size);
  std::free(out);
  return done ? jpeg : Jpeg{};
}

}  // namespace tactus::visual
