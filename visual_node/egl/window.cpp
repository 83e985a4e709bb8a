#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <stdexcept>

#include "visual_node/egl/display.h"

namespace tactus::visual {
namespace {

class Window : public Display {
 public:
  Window(const std::string& title, int width, int height) {
    if (!glfwInit()) refuse();
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!window_) refuse();
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(0);  // the loop has its own pace and waits for no screen
    description_ = std::string(reinterpret_cast<const char*>(glGetString(GL_RENDERER))) + " in a window";
  }
  ~Window() override { glfwTerminate(); }

  void show(unsigned framebuffer, int width, int height) override {
    int window_width = 0, window_height = 0;
    glfwGetFramebufferSize(window_, &window_width, &window_height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glDisable(GL_FRAMEBUFFER_SRGB);  // the bytes are encoded already
    glBlitFramebuffer(0, 0, width, height, 0, 0, window_width, window_height, GL_COLOR_BUFFER_BIT, GL_LINEAR);
    glfwSwapBuffers(window_);
    glfwPollEvents();
  }
  bool closed() override { return glfwWindowShouldClose(window_); }
  bool has_screen() const override { return true; }

 private:
  [[noreturn]] static void refuse() {
    const char* why = nullptr;
    glfwGetError(&why);
    const std::string reason = why ? why : "unknown reason";
    glfwTerminate();
    throw std::runtime_error(
        "--window: no window can be opened (" + reason +
        "); start it on a desktop with DISPLAY or WAYLAND_DISPLAY set, or leave --window out");
  }
  GLFWwindow* window_ = nullptr;
};

}  // namespace

std::unique_ptr<Display> make_window(const std::string& title, int width, int height) {
  return std::make_unique<Window>(title, width, height);
}

}  // namespace tactus::visual
