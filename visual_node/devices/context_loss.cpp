#include "visual_node/devices/context_loss.h"

#include <epoxy/gl.h>

namespace tactus::visual {

std::string context_loss_reason() {
  // libepoxy aborts the process when the driver has none of these.
  if (epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_KHR_robustness") ||
      epoxy_has_gl_extension("GL_ARB_robustness")) {
    switch (glGetGraphicsResetStatus()) {
      case GL_NO_ERROR: return {};
      case GL_GUILTY_CONTEXT_RESET: return "the graphics device was reset after what this node drew";
      case GL_INNOCENT_CONTEXT_RESET: return "the graphics device was reset after what another program drew";
      default: return "the graphics device was reset";
    }
  }
  // Other errors do not mean that the context is lost. The loop calls this once a frame, so 16 reads drain nearly
  // all pending errors.
  for (int i = 0; i < 16; ++i) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) return {};
    if (error == GL_CONTEXT_LOST) return "the graphics device has lost its data";
  }
  return {};
}

}  // namespace tactus::visual
