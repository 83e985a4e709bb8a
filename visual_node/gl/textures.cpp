#include "visual_node/gl/textures.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace tactus::visual {
namespace {

// A face covers a quarter of the circle: without loss its edge is a quarter of the picture's width. It is limited
// to this, 24 MB in total: a mirror of the size of a hand shows less detail.
constexpr int kMaxFace_px = 1024;

// The direction of a texel of a face; s and t from -1 to 1. OpenGL 3.3, table 3.21.
Eigen::Vector3d through(int face, double s, double t) {
  switch (face) {
    case 0: return {1, -t, -s};
    case 1: return {-1, -t, s};
    case 2: return {s, 1, t};
    case 3: return {s, -1, -t};
    case 4: return {s, -t, 1};
    default: return {-s, -t, -1};
  }
}

// Bilinear between the centres of four pixels; wraps around in longitude, ends at the poles. Interpolates the
// encoded values, since neighbours are similar.
std::array<std::uint8_t, 4> sample(const sync::Raster& r, const Eigen::Vector2d& at) {
  const double x = at.x() * r.width - 0.5, y = std::clamp(at.y() * r.height - 0.5, 0.0, r.height - 1.0);
  const int left = static_cast<int>(std::floor(x)), below = std::min(static_cast<int>(y), r.height - 1);
  const double along_x = x - left, along_y = y - below;
  const auto texel = [&](int column, int row, int k) -> double {
    column = ((column % r.width) + r.width) % r.width, row = std::min(row, r.height - 1);
    return r.rgba[static_cast<std::size_t>(4 * (row * r.width + column) + k)];
  };
  std::array<std::uint8_t, 4> mixed{};
  for (int k = 0; k < 4; ++k)
    mixed[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(std::lround(
        (1 - along_y) * ((1 - along_x) * texel(left, below, k) + along_x * texel(left + 1, below, k)) +
        along_y * ((1 - along_x) * texel(left, below + 1, k) + along_x * texel(left + 1, below + 1, k))));
  return mixed;
}

void finish(unsigned kind, unsigned wrap) {
  glGenerateMipmap(kind);
  glTexParameteri(kind, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(kind, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const auto axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTexParameteri(kind, axis, static_cast<int>(wrap));
}

}  // namespace

Eigen::Vector2d equirectangular_uv(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d d = direction.normalized();
  return {0.5 - std::atan2(d.y(), d.x()) / (2 * std::numbers::pi),
          0.5 + std::asin(std::clamp(d.z(), -1.0, 1.0)) / std::numbers::pi};
}

SurfaceTexture::SurfaceTexture(const sync::Raster& r, bool encoded) {
  glBindTexture(GL_TEXTURE_2D, id_);
  glTexImage2D(GL_TEXTURE_2D, 0, encoded ? GL_SRGB8_ALPHA8 : GL_RGBA8, r.width, r.height, 0, GL_RGBA,
               GL_UNSIGNED_BYTE, r.rgba.data());
  finish(GL_TEXTURE_2D, GL_REPEAT);
}

EnvironmentTexture::EnvironmentTexture(const sync::Raster& around) {
  glBindTexture(GL_TEXTURE_CUBE_MAP, id_);
  const int edge = std::clamp(around.width / 4, 1, kMaxFace_px);
  std::vector<std::uint8_t> rgba(static_cast<std::size_t>(4 * edge * edge));
  for (int face = 0; face < 6; ++face) {
    for (int row = 0; row < edge; ++row)
      for (int column = 0; column < edge; ++column) {
        const double s = 2 * (column + 0.5) / edge - 1, t = 2 * (row + 0.5) / edge - 1;
        const auto texel = sample(around, equirectangular_uv(through(face, s, t)));
        std::copy(texel.begin(), texel.end(), rgba.begin() + 4 * (row * edge + column));
      }
    glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<unsigned>(face), 0, GL_SRGB8_ALPHA8, edge, edge, 0,
                 GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  }
  finish(GL_TEXTURE_CUBE_MAP, GL_CLAMP_TO_EDGE);
  glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
}

EnvironmentTexture::EnvironmentTexture(const Eigen::Vector3f& colour) {
  glBindTexture(GL_TEXTURE_CUBE_MAP, id_);
  for (unsigned face = 0; face < 6; ++face)
    glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_RGB32F, 1, 1, 0, GL_RGB, GL_FLOAT, colour.data());
  finish(GL_TEXTURE_CUBE_MAP, GL_CLAMP_TO_EDGE);
}

}  // namespace tactus::visual
