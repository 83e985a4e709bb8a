#include "visual_node/gl/buffers.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>

namespace tactus::visual {
namespace {

const void* offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

// After the attributes of struct Instance, as in shaders/surface.vert.
constexpr unsigned kPlaceAttribute = 2 + sizeof(Instance) / 16;

void check_complete(const char* what) {
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error(std::string("the graphics driver rejects the ") + what +
                             "; choose a smaller picture or shadow_size");
}

}  // namespace

void StreamBuffer::write(const void* data, std::size_t bytes) {
  glBindBuffer(GL_ARRAY_BUFFER, id_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_STREAM_DRAW);
}

GeometryBuffer::GeometryBuffer(const Triangles& t)
    : index_count_(static_cast<int>(t.indices.size())), two_sided_(t.two_sided) {
  std::vector<Eigen::Vector3f> interleaved;
  interleaved.reserve(2 * t.positions.size());
  for (std::size_t i = 0; i < t.positions.size(); ++i) {
    interleaved.push_back(t.positions[i]);
    interleaved.push_back(t.normals[i]);
  }
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(interleaved.size() * sizeof(Eigen::Vector3f)),
               interleaved.data(), GL_STATIC_DRAW);
  for (unsigned i = 0; i < 2; ++i) {
    glEnableVertexAttribArray(i);
    glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, 2 * sizeof(Eigen::Vector3f),
                          offset(i * sizeof(Eigen::Vector3f)));
  }
  if (!t.texcoords.empty()) {
    std::vector<float> places;
    places.reserve(6 * t.texcoords.size());
    for (std::size_t i = 0; i < t.texcoords.size(); ++i) {
      const Eigen::Vector4f tangent = t.tangents.empty() ? Eigen::Vector4f::Zero() : t.tangents[i];
      places.insert(places.end(),
                    {t.texcoords[i].x(), t.texcoords[i].y(), tangent.x(), tangent.y(), tangent.z(), tangent.w()});
    }
    glBindBuffer(GL_ARRAY_BUFFER, places_);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(places.size() * sizeof(float)), places.data(),
                 GL_STATIC_DRAW);
    for (const unsigned i : {0u, 1u}) {
      glEnableVertexAttribArray(kPlaceAttribute + i);
      glVertexAttribPointer(kPlaceAttribute + i, i == 0 ? 2 : 4, GL_FLOAT, GL_FALSE, 6 * sizeof(float),
                            offset(2 * i * sizeof(float)));
    }
  }
  for (unsigned i = 2; i < 2 + sizeof(Instance) / 16; ++i) {
    glEnableVertexAttribArray(i);
    glVertexAttribDivisor(i, 1);
  }
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(t.indices.size() * sizeof(std::uint32_t)),
               t.indices.data(), GL_STATIC_DRAW);
}

void GeometryBuffer::draw(const StreamBuffer& instances, int first, int count) const {
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, instances.id());
  // OpenGL 3.3 has no base instance, so the attribute pointers start at the batch.
  for (unsigned i = 0; i < sizeof(Instance) / 16; ++i)
    glVertexAttribPointer(2 + i, 4, GL_FLOAT, GL_FALSE, sizeof(Instance),
                          offset(static_cast<std::size_t>(first) * sizeof(Instance) + 16 * i));
  glDrawElementsInstanced(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr, count);
}

QuadArray::QuadArray(int floats4) : floats4_(floats4) {
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, instances_.id());
  for (int i = 0; i < floats4_; ++i) {
    const auto attribute = static_cast<unsigned>(i);
    glEnableVertexAttribArray(attribute);
    glVertexAttribPointer(attribute, 4, GL_FLOAT, GL_FALSE, 16 * floats4_, offset(16 * attribute));
    glVertexAttribDivisor(attribute, 1);
  }
}

void QuadArray::draw(const void* data, std::size_t count) {
  if (count == 0) return;
  instances_.write(data, count * 16 * static_cast<std::size_t>(floats4_));
  glBindVertexArray(array_);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<int>(count));
}

ReliefTexture::ReliefTexture(const Relief& relief) : size_m_(relief.size_m) {
  glBindTexture(GL_TEXTURE_2D, id_);
  // Full floats and one mipmap level at a time: on a software renderer both were faster than half floats and two
  // levels.
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RG32F, relief.columns, relief.rows, 0, GL_RG, GL_FLOAT, relief.slopes.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const auto wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTexParameteri(GL_TEXTURE_2D, wrap, GL_REPEAT);
}

PictureTarget::PictureTarget(int width, int height) : width_(width), height_(height) {
  glBindTexture(GL_TEXTURE_2D, colour_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  for (const auto filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
  for (const auto wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_, 0);
  glBindRenderbuffer(GL_RENDERBUFFER, depth_);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  check_complete("picture");
}

void PictureTarget::bind(int width, int height) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width, height);
}

void PictureTarget::read(std::span<std::uint8_t> rgba) const {
  if (rgba.size() < static_cast<std::size_t>(width_ * height_ * 4)) return;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
}

MultisampleTarget::MultisampleTarget(int width, int height, int samples) {
  int max_samples = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &max_samples);
  samples_ = std::min(samples, max_samples);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  const auto attach = [&](unsigned buffer, unsigned format, unsigned where) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples_, format, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, where, GL_RENDERBUFFER, buffer);
  };
  attach(colour_, GL_SRGB8_ALPHA8, GL_COLOR_ATTACHMENT0);
  attach(depth_, GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT);
  check_complete("picture of several samples per pixel");
}

void MultisampleTarget::bind(int width, int height) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width, height);
}

void MultisampleTarget::resolve(const PictureTarget& picture, int width, int height) const {
  glEnable(GL_FRAMEBUFFER_SRGB);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, picture.framebuffer());
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  picture.bind(width, height);
}

ShadowTarget::ShadowTarget(int size) : size_(size) {
  glBindTexture(GL_TEXTURE_2D, depth_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, size, size, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT,
               nullptr);
  for (const auto filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
  for (const auto wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_, 0);
  glDrawBuffer(GL_NONE);
  check_complete("shadow map");
}

void ShadowTarget::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, size_, size_);
}

}  // namespace tactus::visual
