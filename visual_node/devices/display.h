// Where the pictures go: nowhere (a context without a display server) or a window. EGL and GLFW stay behind this.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "visual_node/devices/gamepad.h"

namespace tactus::visual {

// What a person did in a window.
struct Inputs {
  std::vector<int> keys;  // pressed, in order: as overlay/keys.h has them
  // Where the cursor is while the left button is held: shares of the window from its upper left.
  std::optional<std::pair<float, float>> aim;
  std::vector<Button> buttons;  // of any gamepad, pressed anew
};

struct WindowOptions {
  int width = 640, height = 480;
  bool full_screen = false;
  int monitor = 0;           // 0: the first
  bool quad_buffer = false;  // a buffer for each eye
};

class Display {
 public:
  virtual ~Display() = default;
  // What draws, e.g. "llvmpipe (LLVM 15.0.6, 256 bits) on EGL device 0".
  const std::string& description() const { return description_; }
  // Shows the picture in this framebuffer; without a window it does nothing. halves: its left half to the left
  // eye, its right half to the right one, where the display can.
  virtual void show(unsigned framebuffer, int width, int height, bool halves = false) = 0;
  // True once a person has closed the window.
  virtual bool closed() = 0;
  // Why nothing can be drawn with it any more, as a clause; empty: it can.
  virtual std::string lost() = 0;
  // It is lost since there is no display server any more that a window could be opened on again.
  virtual bool server_gone() { return false; }
  // True when show() adds a wait for the screen to what the fence knows.
  virtual bool has_screen() const = 0;
  // Since it was asked last.
  virtual Inputs take_inputs() { return {}; }
  virtual void toggle_full_screen() {}
  // One sentence on what does not go as it was asked for; told once, then empty.
  std::string take_trouble() { return std::exchange(trouble_, {}); }

 protected:
  std::string description_, trouble_;
};

// An OpenGL 3.3 core context is current in the calling thread afterwards. Tries the EGL device of that index (-1:
// none in particular), then every device, then surfaceless, then the default display. Throws std::runtime_error
// with one sentence that lists what was tried.
std::unique_ptr<Display> make_headless(int egl_device);

// A window of the desktop. Throws std::runtime_error with one sentence when there is no display server.
std::unique_ptr<Display> make_window(const std::string& title, const WindowOptions& options);

// A software renderer draws with one thread, so that the 1 kHz loops keep a core, unless the user has said
// otherwise. Call before anything else.
void quiet_software_renderer();

}  // namespace tactus::visual
