// Objects in the memory of the graphics device: triangles, per-frame instances, and the render targets.
#pragma once

#include <span>

#include "visual_node/scene_view/draw_list.h"
#include "visual_node/scene_view/relief.h"
#include "visual_node/scene_view/triangles.h"

namespace tactus::visual {

// Per-instance data, rewritten each frame.
class StreamBuffer {
 public:
  StreamBuffer();
  ~StreamBuffer();
  StreamBuffer(const StreamBuffer&) = delete;
  StreamBuffer& operator=(const StreamBuffer&) = delete;
  void write(const void* data, std::size_t bytes);
  unsigned id() const { return id_; }

 private:
  unsigned id_ = 0;
};

// The triangles of one geometry.
class GeometryBuffer {
 public:
  explicit GeometryBuffer(const Triangles& triangles);
  ~GeometryBuffer();
  GeometryBuffer(const GeometryBuffer&) = delete;
  GeometryBuffer& operator=(const GeometryBuffer&) = delete;
  // Draws `count` instances that begin at index `first` in the stream of Instances.
  void draw(const StreamBuffer& instances, int first, int count) const;
  bool two_sided() const { return two_sided_; }

 private:
  unsigned array_ = 0, vertices_ = 0, places_ = 0, indices_ = 0;
  int index_count_ = 0;
  bool two_sided_ = false;
};

// Quads without a vertex buffer: `floats4` vec4 attributes per instance.
class QuadArray {
 public:
  explicit QuadArray(int floats4);
  ~QuadArray();
  QuadArray(const QuadArray&) = delete;
  QuadArray& operator=(const QuadArray&) = delete;
  void draw(const void* data, std::size_t count);

 private:
  unsigned array_ = 0;
  int floats4_;
  StreamBuffer instances_;
};

// Slopes of a relief, repeated in both directions and filtered, so that distant surfaces are flat.
class ReliefTexture {
 public:
  explicit ReliefTexture(const Relief& relief);
  ~ReliefTexture();
  ReliefTexture(const ReliefTexture&) = delete;
  ReliefTexture& operator=(const ReliefTexture&) = delete;
  unsigned id() const { return id_; }
  const Eigen::Vector2f& size_m() const { return size_m_; }

 private:
  unsigned id_ = 0;
  Eigen::Vector2f size_m_;
};

// A render target: sRGB colour and depth. Colour is encoded on writing, so that light is added in linear space.
class PictureTarget {
 public:
  PictureTarget(int width, int height);
  ~PictureTarget();
  PictureTarget(const PictureTarget&) = delete;
  PictureTarget& operator=(const PictureTarget&) = delete;
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
  unsigned framebuffer_ = 0, colour_ = 0, depth_ = 0;
};

// A render target with several samples per pixel, for smooth edges.
class MultisampleTarget {
 public:
  // Uses `samples`, or the maximum of the device.
  MultisampleTarget(int width, int height, int samples);
  ~MultisampleTarget();
  MultisampleTarget(const MultisampleTarget&) = delete;
  MultisampleTarget& operator=(const MultisampleTarget&) = delete;
  int samples() const { return samples_; }
  void bind(int width, int height) const;
  // Each pixel of the picture becomes the mean of its samples, in linear light.
  void resolve(const PictureTarget& picture, int width, int height) const;

 private:
  int samples_;
  unsigned framebuffer_ = 0, colour_ = 0, depth_ = 0;
};

// Depth seen from the lamp, compared and filtered by the sampler.
class ShadowTarget {
 public:
  explicit ShadowTarget(int size);
  ~ShadowTarget();
  ShadowTarget(const ShadowTarget&) = delete;
  ShadowTarget& operator=(const ShadowTarget&) = delete;
  void bind() const;
  unsigned texture() const { return depth_; }

 private:
  int size_;
  unsigned framebuffer_ = 0, depth_ = 0;
};

}  // namespace tactus::visual
