#include "visual_node/video/i420.h"

namespace tactus::visual {
namespace {

void luma_row(const std::uint8_t* __restrict rgba, int width, std::uint8_t* __restrict y) {
  for (int x = 0; x < width; ++x) {
    const int r = rgba[4 * x], g = rgba[4 * x + 1], b = rgba[4 * x + 2];
    y[x] = static_cast<std::uint8_t>(16 + ((47 * r + 157 * g + 16 * b + 128) >> 8));
  }
}

void chroma_row(const std::uint8_t* __restrict upper, const std::uint8_t* __restrict lower, int pairs,
                std::uint8_t* __restrict u, std::uint8_t* __restrict v) {
  for (int x = 0; x < pairs; ++x) {
    const int i = 8 * x;
    const int r = upper[i] + upper[i + 4] + lower[i] + lower[i + 4];
    const int g = upper[i + 1] + upper[i + 5] + lower[i + 1] + lower[i + 5];
    const int b = upper[i + 2] + upper[i + 6] + lower[i + 2] + lower[i + 6];
    u[x] = static_cast<std::uint8_t>(128 + ((-26 * r - 86 * g + 112 * b + 512) >> 10));
    v[x] = static_cast<std::uint8_t>(128 + ((112 * r - 102 * g - 10 * b + 512) >> 10));
  }
}

}  // namespace

void rgba_to_i420(std::span<const std::uint8_t> rgba, int width, int height, std::span<std::uint8_t> out) {
  const int half = width / 2;
  std::uint8_t* const u = out.data() + width * height;
  std::uint8_t* const v = u + half * (height / 2);
  const auto row = [&](int y) { return rgba.data() + static_cast<std::ptrdiff_t>(height - 1 - y) * width * 4; };
  for (int y = 0; y < height; ++y) luma_row(row(y), width, out.data() + y * width);
  for (int y = 0; y < height / 2; ++y) chroma_row(row(2 * y), row(2 * y + 1), half, u + y * half, v + y * half);
}

}  // namespace tactus::visual
