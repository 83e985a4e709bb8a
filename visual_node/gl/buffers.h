// Objects in the memory of the graphics device: triangles, per-frame instances, and the render targets.
#pragma once

#include <span>

#include "visual_node/gl/gl_object.h"
#include "visual_node/scene_view/draw_list.h"
#include "visual_node/scene_view/relief.h"
#include "visual_node/scene_view/triangles.h"

namespace tactus::visual {

// Per-instance data, rewritten each frame.
class StreamBuffer {
 public:
  void write(const void* data, std::size_t bytes);
  unsigned id() const { return id_; }

 private:
  GlObject id_{GlObject::Kind::kBuffer};
};

// The triangles of one geometry.
class GeometryBuffer {
 public:
  explicit GeometryBuffer(const Triangles& triangles);
  // Draws `count` instances that begin at index `first` in the stream of Instances.
  void draw(const StreamBuffer& instances, int first, int count) const;
  bool two_sided() const { return two_sided_; }

 private:
  GlObject array_{GlObject::Kind::kVertexArray}, vertices_{GlObject::Kind::kBuffer}, places_{GlObject::Kind::kBuffer},
      indices_{GlObject::Kind::kBuffer};
  int index_count_ = 0;
  bool two_sided_ = false;
};

// Quads without a vertex buffer: `floats4` vec4 attributes per instance.
class QuadArray {
 public:
  explicit QuadArray(int floats4);
  void draw(const void* data, std::size_t count);

 private:
  GlObject array_{GlObject::Kind::kVertexArray};
  int floats4_;
  StreamBuffer instances_;
};

// Slopes of a relief, repeated in both directions and filtered, so that distant surfaces are flat.
class ReliefTexture {
 public:
  explicit ReliefTexture(const Relief& relief);
  unsigned id() const { return id_; }
  const Eigen::Vector2f& size_m() const { return size_m_; }

 private:
  GlObject id_{GlObject::Kind::kTexture};
  Eigen::Vector2f size_m_;
};

// A render target: sRGB colour and depth. Colour is encoded on writing, so that light is added in linear space.
class PictureTarget {
 public:
  PictureTarget(int width, int height);
  // Binds all of it, or this many pixels at the lower left.
  void bind() const { bind(width_, height_); }
  void bind(int width, int height) const;
  // sRGB bytes, 4 a pixel, the lowest row first. Blocks until the picture is finished.
  void read(std::span<std::uint8_t> rgba) const;
  unsigned framebuffer() const { return framebuffer_; }
  unsigned texture() const { return colour_; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  int width_, height_;
  GlObject framebuffer_{GlObject::Kind::kFramebuffer}, colour_{GlObject::Kind::kTexture},
      depth_{GlObject::Kind::kRenderbuffer};
};

// A render target with several samples per pixel, for smooth edges.
class MultisampleTarget {
 public:
  // Uses `samples`, or the maximum of the device.
  MultisampleTarget(int width, int height, int samples);
  int samples() const { return samples_; }
  void bind(int width, int height) const;
  // Each pixel of the picture becomes the mean of its samples, in linear light.
  void resolve(const PictureTarget& picture, int width, int height) const;

 private:
  int samples_;
  GlObject framebuffer_{GlObject::Kind::kFramebuffer}, colour_{GlObject::Kind::kRenderbuffer},
      depth_{GlObject::Kind::kRenderbuffer};
};

// Depth seen from the lamp, compared and filtered by the sampler.
class ShadowTarget {
 public:
  explicit ShadowTarget(int size);
  void bind() const;
  unsigned texture() const { return depth_; }

 private:
  int size_;
  GlObject framebuffer_{GlObject::Kind::kFramebuffer}, depth_{GlObject::Kind::kTexture};
};

}  // namespace tactus::visual
