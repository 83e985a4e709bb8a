// Where the pictures go: nowhere (a context without a display server) or a window. EGL and GLFW stay behind this.
#pragma once

#include <memory>
#include <string>

namespace tactus::visual {

class Display {
 public:
  virtual ~Display() = default;
  // What draws, e.g. "llvmpipe (LLVM 15.0.6, 256 bits) on EGL device 0".
  const std::string& description() const { return description_; }
  // Shows the picture in this framebuffer; without a window it does nothing.
  virtual void show(unsigned framebuffer, int width, int height) = 0;
  // True once the window was closed.
  virtual bool closed() = 0;
  // True when show() adds a wait for the screen to what the fence knows.
  virtual bool has_screen() const = 0;

 protected:
  std::string description_;
};

// An OpenGL 3.3 core context is current in the calling thread afterwards. Tries the EGL device of that index (-1:
// none in particular), then every device, then surfaceless, then the default display. Throws std::runtime_error
// with one sentence that lists what was tried.
std::unique_ptr<Display> make_headless(int egl_device);

// A window of the desktop. Throws std::runtime_error with one sentence when there is no display server.
std::unique_ptr<Display> make_window(const std::string& title, int width, int height);

// A software renderer draws with one thread, so that the 1 kHz loops keep a core, unless the user has said
// otherwise. Call before anything else.
void quiet_software_renderer();

}  // namespace tactus::visual
