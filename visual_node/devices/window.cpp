#include <dlfcn.h>
#include <poll.h>

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>

#include "visual_node/devices/call_guard.h"
#include "visual_node/devices/context_loss.h"
#include "visual_node/devices/display.h"

// Declared here because GLFW's header for them includes the headers of X11.
extern "C" void* glfwGetX11Display();
extern "C" unsigned long glfwGetX11Window(GLFWwindow* window);

namespace tactus::visual {
namespace {

// Copy of XErrorEvent in the X11 headers, and two of its error codes.
struct ProtocolError {
  int type;
  void* display;
  unsigned long resource, serial;
  unsigned char code, request, minor;
};
constexpr unsigned char kBadWindow = 3, kBadDrawable = 9;

constexpr std::size_t kMaxKeys = 64;  // between two frames

// Only the arrows repeat while held: they move a slider.
bool repeats(int key) {
  return key == GLFW_KEY_LEFT || key == GLFW_KEY_RIGHT || key == GLFW_KEY_UP || key == GLFW_KEY_DOWN;
}

GamepadState state_of(const GLFWgamepadstate& s) {
  constexpr std::array<int, kButtons> kAs{GLFW_GAMEPAD_BUTTON_A,         GLFW_GAMEPAD_BUTTON_B,
                                          GLFW_GAMEPAD_BUTTON_X,         GLFW_GAMEPAD_BUTTON_Y,
                                          GLFW_GAMEPAD_BUTTON_DPAD_LEFT, GLFW_GAMEPAD_BUTTON_DPAD_RIGHT,
                                          GLFW_GAMEPAD_BUTTON_DPAD_UP,   GLFW_GAMEPAD_BUTTON_DPAD_DOWN};
  GamepadState out;
  for (std::size_t i = 0; i < kButtons; ++i) out.held[i] = s.buttons[kAs[i]] == GLFW_PRESS;
  out.sticks = {{{s.axes[GLFW_GAMEPAD_AXIS_LEFT_X], s.axes[GLFW_GAMEPAD_AXIS_LEFT_Y]},
                 {s.axes[GLFW_GAMEPAD_AXIS_RIGHT_X], s.axes[GLFW_GAMEPAD_AXIS_RIGHT_Y]}}};
  return out;
}

class Window : public Display {
 public:
  Window(const std::string& title, const WindowOptions& o) : windowed_width_(o.width), windowed_height_(o.height) {
    if (!glfwInit()) reject();
    choose_monitor(o.monitor);
    stay_on_monitor();
    // EGL has no stereo buffers; the native contexts of the desktop may have them.
    if (o.quad_buffer) open(title, o, GLFW_NATIVE_CONTEXT_API, true);
    if (!window_) {
      if (o.quad_buffer)
        warning_ += std::string(warning_.empty() ? "" : "; ") +
                    "this display has no buffer for each eye; both eyes are shown side by side";
      open(title, o, GLFW_EGL_CONTEXT_API, false);
    }
    if (!window_) reject();
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(0);  // the loop has its own pace and does not wait for the screen
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int) {
      auto& keys = static_cast<Window*>(glfwGetWindowUserPointer(w))->keys_;
      if ((action == GLFW_PRESS || (action == GLFW_REPEAT && repeats(key))) && keys.size() < kMaxKeys)
        keys.push_back(key);
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
      static_cast<Window*>(glfwGetWindowUserPointer(w))->cursor_ = {x, y};
    });
    glfwSetWindowPosCallback(window_, [](GLFWwindow* w, int, int) {
      static_cast<Window*>(glfwGetWindowUserPointer(w))->cursor_.reset();
    });
    handle_server_loss();
    description_ = std::string(reinterpret_cast<const char*>(glGetString(GL_RENDERER))) + " in a window";
    if (o.full_screen) toggle_full_screen();
  }
  ~Window() override {
    if (!lost_) glfwTerminate();  // a call to a display server that is gone would end the process
  }

  void show(unsigned framebuffer, int width, int height, bool halves) override {
    if (!lost_ && !(lost_ = server_hung_up()))
      guard_.run_guarded([&] { put(framebuffer, width, height, halves); });
  }
  bool closed() override {
    return !lost_ && (glfwWindowShouldClose(window_) || (x11_window_ != 0 && destroyed_ == x11_window_));
  }
  std::string loss_reason() override {
    return lost_ ? "the display server of the window is gone" : context_loss_reason();
  }
  bool server_gone() override { return lost_; }
  bool has_screen() const override { return true; }

  Inputs take_inputs() override {
    Inputs inputs;
    guard_.run_guarded([&] { inputs = inputs_now(); });
    return inputs;
  }

  void toggle_full_screen() override {
    if (lost_) return;
    if (glfwGetWindowMonitor(window_)) {
      glfwSetWindowMonitor(window_, nullptr, windowed_x_, windowed_y_, windowed_width_, windowed_height_,
                           GLFW_DONT_CARE);
      return;
    }
    const GLFWvidmode* mode = monitor_ ? glfwGetVideoMode(monitor_) : nullptr;
    if (!mode) {
      warning_ = "no monitor was found: the window keeps its size";
      return;
    }
    glfwGetWindowPos(window_, &windowed_x_, &windowed_y_);
    glfwGetWindowSize(window_, &windowed_width_, &windowed_height_);
    glfwSetWindowMonitor(window_, monitor_, 0, 0, mode->width, mode->height, mode->refreshRate);
    glfwSwapInterval(0);
  }

 private:
  void put(unsigned framebuffer, int width, int height, bool halves) {
    int window_width = 0, window_height = 0;
    glfwGetFramebufferSize(window_, &window_width, &window_height);
    // Show nothing in a window that is iconified or has no size; a desktop may block its buffer swap until it
    // is visible.
    if (window_width > 0 && window_height > 0 && !glfwGetWindowAttrib(window_, GLFW_ICONIFIED)) {
      glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
      glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
      glDisable(GL_FRAMEBUFFER_SRGB);  // the bytes are encoded already
      const auto blit = [&](int left, int right) {
        glBlitFramebuffer(left, 0, right, height, 0, 0, window_width, window_height, GL_COLOR_BUFFER_BIT,
                          GL_LINEAR);
      };
      if (halves && quad_) {
        glDrawBuffer(GL_BACK_LEFT);
        blit(0, width / 2);
        glDrawBuffer(GL_BACK_RIGHT);
        blit(width / 2, width);
      } else {
        if (quad_) glDrawBuffer(GL_BACK);
        blit(0, width);
      }
      glfwSwapBuffers(window_);
    }
    glfwPollEvents();
  }

  Inputs inputs_now() {
    Inputs inputs{std::exchange(keys_, {}), std::nullopt, {}};
    if (!lost_) inputs.buttons = buttons_now();
    if (lost_ || glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_LEFT) != GLFW_PRESS) return inputs;
    int width = 0, height = 0;
    glfwGetWindowSize(window_, &width, &height);
    if (!cursor_) {
      auto& [x, y] = cursor_.emplace();
      glfwGetCursorPos(window_, &x, &y);
    }
    const auto [x, y] = *cursor_;
    if (width > 0 && height > 0 && x >= 0 && y >= 0 && x <= width && y <= height)
      inputs.aim.emplace(static_cast<float>(x / width), static_cast<float>(y / height));
    return inputs;
  }

  std::vector<Button> buttons_now() {
    std::vector<Button> all;
    for (int i = 0; i <= GLFW_JOYSTICK_LAST; ++i) {
      GLFWgamepadstate state;
      if (!glfwGetGamepadState(i, &state)) {
        gamepads_[static_cast<std::size_t>(i)].reset();
        continue;
      }
      const auto pressed = gamepads_[static_cast<std::size_t>(i)].pressed(state_of(state));
      all.insert(all.end(), pressed.begin(), pressed.end());
    }
    return all;
  }

  void choose_monitor(int number) {
    int count = 0;
    GLFWmonitor** monitors = glfwGetMonitors(&count);
    if (count == 0) return;
    if (number >= count)
      warning_ = "there is no monitor " + std::to_string(number) + "; using the last of " + std::to_string(count) +
                 ", counted from 0";
    monitor_ = monitors[std::clamp(number, 0, count - 1)];
  }

  // A software renderer allocates memory for the whole window, visible or not.
  void stay_on_monitor() {
    const GLFWvidmode* mode = monitor_ ? glfwGetVideoMode(monitor_) : nullptr;
    const int max_width = mode ? mode->width : 4096, max_height = mode ? mode->height : 4096;
    if (windowed_width_ > max_width || windowed_height_ > max_height)
      warning_ += std::string(warning_.empty() ? "" : "; ") +
                  "the window is larger than its monitor; it is reduced to " +
                  std::to_string(std::min(windowed_width_, max_width)) + " x " +
                  std::to_string(std::min(windowed_height_, max_height)) + " pixels";
    windowed_width_ = std::clamp(windowed_width_, 1, max_width);
    windowed_height_ = std::clamp(windowed_height_, 1, max_height);
  }

  void open(const std::string& title, const WindowOptions& o, int api, bool stereo) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, api);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_STEREO, stereo ? GLFW_TRUE : GLFW_FALSE);
    for (const int unused : {GLFW_DEPTH_BITS, GLFW_STENCIL_BITS, GLFW_ALPHA_BITS}) glfwWindowHint(unused, 0);
    window_ = glfwCreateWindow(windowed_width_, windowed_height_, title.c_str(), nullptr, nullptr);
    quad_ = window_ && stereo;
    if (!window_) return;
    if (monitor_) {
      int x = 0, y = 0;
      glfwGetMonitorPos(monitor_, &x, &y);
      if (o.monitor > 0) glfwSetWindowPos(window_, x, y);
    }
  }

  // Xlib prints the cause and ends the process when its server goes away, unless both handlers are replaced. GLFW
  // loads Xlib at run time, so this function looks up its symbols and does not link it.
  void handle_server_loss() {
    using ErrorHandler = int (*)(void*);
    using ExitHandler = void (*)(void*, void*);
    using SetProtocol = void* (*)(int (*)(void*, const ProtocolError*));
    using SetError = ErrorHandler (*)(ErrorHandler);
    using SetExit = void (*)(void*, ExitHandler, void*);
    void* library = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
    if (!library) return;  // a desktop without X11
    const auto set_error = reinterpret_cast<SetError>(dlsym(library, "XSetIOErrorHandler"));
    const auto set_exit = reinterpret_cast<SetExit>(dlsym(library, "XSetIOErrorExitHandler"));
    void* display = set_error && set_exit ? glfwGetX11Display() : nullptr;
    if (!display) return;
    x11_window_ = glfwGetX11Window(window_);
    using Number = int (*)(void*);
    if (const auto number = reinterpret_cast<Number>(dlsym(library, "XConnectionNumber")))
      connection_ = number(display);
    set_error([](void*) { return 0; });
    // Likewise ignore errors about a window that another program has destroyed.
    const auto set_protocol = reinterpret_cast<SetProtocol>(dlsym(library, "XSetErrorHandler"));
    if (set_protocol)
      set_protocol([](void*, const ProtocolError* e) {
        if (e->code == kBadWindow || e->code == kBadDrawable) destroyed_ = e->resource;
        return 0;
      });
    set_exit(
        display, [](void*, void* window) { static_cast<Window*>(window)->lost_ = true; }, this);
  }

  // Called before every swap: Mesa's swap never returns once the connection is broken.
  bool server_hung_up() const {
    if (connection_ < 0) return false;
    pollfd fd{connection_, 0, 0};
    return ::poll(&fd, 1, 0) > 0 && (fd.revents & (POLLHUP | POLLERR | POLLNVAL));
  }

  [[noreturn]] static void reject() {
    const char* why = nullptr;
    glfwGetError(&why);
    const std::string reason = why ? why : "unknown reason";
    glfwTerminate();
    throw std::runtime_error("--window: no window can be opened (" + reason +
                             "); start it on a desktop with DISPLAY or WAYLAND_DISPLAY set, or remove --window");
  }
  GLFWwindow* window_ = nullptr;
  GLFWmonitor* monitor_ = nullptr;
  bool quad_ = false, lost_ = false;
  CallGuard guard_;
  int connection_ = -1;                        // to the X server
  unsigned long x11_window_ = 0;               // 0: not X11
  static inline unsigned long destroyed_ = 0;  // static: Xlib passes no user data to its handler
  int windowed_x_ = 0, windowed_y_ = 0, windowed_width_, windowed_height_;
  std::vector<int> keys_;
  // Position of the mouse by the same events that report its button. glfwGetCursorPos asks the server for the
  // position now, when the button may be released and the mouse may have moved. It is used only for a mouse that
  // has not moved yet, or whose window has moved under it, which no mouse event reports.
  std::optional<std::array<double, 2>> cursor_;
  std::array<Gamepad, GLFW_JOYSTICK_LAST + 1> gamepads_;
};

}  // namespace

std::unique_ptr<Display> make_window(const std::string& title, const WindowOptions& options) {
  return std::make_unique<Window>(title, options);
}

}  // namespace tactus::visual
