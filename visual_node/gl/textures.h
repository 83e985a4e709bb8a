// Textures of the graphics device: maps of surfaces and the environment.
#pragma once

#include <Eigen/Core>

#include "sync/pictures/raster.h"
#include "visual_node/gl/gl_object.h"

namespace tactus::visual {

// Repeated in both directions, filtered. encoded: the colours are sRGB; otherwise linear numbers.
class SurfaceTexture {
 public:
  SurfaceTexture(const sync::Raster& raster, bool encoded);
  unsigned id() const { return id_; }

 private:
  GlObject id_{GlObject::Kind::kTexture};
};

// The environment in each direction, as a cube map.
class EnvironmentTexture {
 public:
  // From an equirectangular picture, as defined in scene_t.lcm.
  explicit EnvironmentTexture(const sync::Raster& around);
  // One colour in all directions, linear.
  explicit EnvironmentTexture(const Eigen::Vector3f& colour);
  unsigned id() const { return id_; }

 private:
  GlObject id_{GlObject::Kind::kTexture};
};

// The place of a direction in that picture: shares of width and height from the lower left, 0 .. 1.
Eigen::Vector2d equirectangular_uv(const Eigen::Vector3d& direction);

}  // namespace tactus::visual
