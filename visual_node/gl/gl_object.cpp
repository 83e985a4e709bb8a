#include "visual_node/gl/gl_object.h"

#include <epoxy/gl.h>

namespace tactus::visual {

GlObject::GlObject(Kind kind) : kind_(kind) {
  switch (kind_) {
    case Kind::kBuffer: glGenBuffers(1, &id_); break;
    case Kind::kFramebuffer: glGenFramebuffers(1, &id_); break;
    case Kind::kRenderbuffer: glGenRenderbuffers(1, &id_); break;
    case Kind::kTexture: glGenTextures(1, &id_); break;
    case Kind::kVertexArray: glGenVertexArrays(1, &id_); break;
  }
}

GlObject::~GlObject() {
  switch (kind_) {
    case Kind::kBuffer: glDeleteBuffers(1, &id_); break;
    case Kind::kFramebuffer: glDeleteFramebuffers(1, &id_); break;
    case Kind::kRenderbuffer: glDeleteRenderbuffers(1, &id_); break;
    case Kind::kTexture: glDeleteTextures(1, &id_); break;
    case Kind::kVertexArray: glDeleteVertexArrays(1, &id_); break;
  }
}

}  // namespace tactus::visual
