// The OpenGL context and its output: headless (no display server) or a window. Hides EGL and GLFW.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "visual_node/devices/gamepad.h"

namespace tactus::visual {

// User input of a window.
struct Inputs {
  std::vector<int> keys;  // pressed, in order; codes as in overlay/keys.h
  // Position of the cursor while the left button is held: fractions of the window's width and height, from its
  // upper left corner.
  std::optional<std::pair<float, float>> aim;
  std::vector<Button> buttons;  // newly pressed, of any gamepad
};

struct WindowOptions {
  int width = 640, height = 480;
  bool full_screen = false;
  int monitor = 0;           // 0: the first
  bool quad_buffer = false;  // one buffer for each eye (quad-buffered stereo)
};

class Display {
 public:
  virtual ~Display() = default;
  // The renderer, e.g. "llvmpipe (LLVM 15.0.6, 256 bits) on EGL device 0".
  const std::string& description() const { return description_; }
  // Shows the picture of this framebuffer; does nothing without a window. halves: shows its left half to the left
  // eye and its right half to the right eye, if the display can.
  virtual void show(unsigned framebuffer, int width, int height, bool halves = false) = 0;
  // True once the user has closed the window.
  virtual bool closed() = 0;
  // The reason why this display can no longer draw, as a clause; empty while it can.
  virtual std::string loss_reason() = 0;
  // True when the display is lost because the display server is gone, so no new window can be opened.
  virtual bool server_gone() { return false; }
  // True when the screen adds a delay after the fence of show().
  virtual bool has_screen() const = 0;
  // The input since the last call.
  virtual Inputs take_inputs() { return {}; }
  virtual void toggle_full_screen() {}
  // One sentence about a request that could not be met; returned once, then empty.
  std::string take_warning() { return std::exchange(warning_, {}); }

 protected:
  std::string description_, warning_;
};

// Makes an OpenGL 3.3 core context current in the calling thread. Tries the EGL device of this index (-1: no
// preference), then every device, then surfaceless, then the default display. Throws std::runtime_error with one
// sentence that lists all attempts.
std::unique_ptr<Display> make_headless(int egl_device);

// Opens a window on the desktop. Throws std::runtime_error with one sentence when there is no display server.
std::unique_ptr<Display> make_window(const std::string& title, const WindowOptions& options);

// Configures a software renderer: one thread, so that the 1 kHz loops keep a core, unless the user has configured
// it. Call this first in the process.
void configure_software_renderer();

}  // namespace tactus::visual
