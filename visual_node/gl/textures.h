// Pictures in the memory of the graphics device: laid on surfaces, or all around the scene.
#pragma once

#include <Eigen/Core>

#include "visual_node/scene_view/raster.h"

namespace tactus::visual {

// Repeated without end, filtered. encoded: its colours are sRGB; else they are numbers as they stand.
class SurfaceTexture {
 public:
  SurfaceTexture(const Raster& raster, bool encoded);
  ~SurfaceTexture();
  SurfaceTexture(const SurfaceTexture&) = delete;
  SurfaceTexture& operator=(const SurfaceTexture&) = delete;
  unsigned id() const { return id_; }

 private:
  unsigned id_ = 0;
};

// What lies in each direction, on the faces of a cube.
class EnvironmentTexture {
 public:
  // Of a picture of longitude and latitude, as scene_t.lcm has it.
  explicit EnvironmentTexture(const Raster& around);
  // The same everywhere, linear.
  explicit EnvironmentTexture(const Eigen::Vector3f& colour);
  ~EnvironmentTexture();
  EnvironmentTexture(const EnvironmentTexture&) = delete;
  EnvironmentTexture& operator=(const EnvironmentTexture&) = delete;
  unsigned id() const { return id_; }

 private:
  unsigned id_ = 0;
};

// Where that picture has what lies in a direction: in its width and height from the lower left, 0 .. 1.
Eigen::Vector2d place_around(const Eigen::Vector3d& direction);

}  // namespace tactus::visual
