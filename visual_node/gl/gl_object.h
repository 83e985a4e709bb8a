// An object in the memory of the graphics device, deleted with its owner.
#pragma once

namespace tactus::visual {

class GlObject {
 public:
  enum class Kind { kBuffer, kFramebuffer, kRenderbuffer, kTexture, kVertexArray };
  explicit GlObject(Kind kind);
  ~GlObject();
  GlObject(const GlObject&) = delete;
  GlObject& operator=(const GlObject&) = delete;
  operator unsigned() const { return id_; }

 private:
  Kind kind_;
  unsigned id_ = 0;
};

}  // namespace tactus::visual
