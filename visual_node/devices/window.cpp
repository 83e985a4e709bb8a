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

// Of GLFW, whose header for it would bring X11's.
extern "C" void* glfwGetX11Display();
extern "C" unsigned long glfwGetX11Window(GLFWwindow* window);

namespace tactus::visual {
namespace {

// XErrorEvent of X11's header, and two of its codes.
struct ProtocolError {
  int type;
  void* display;
  unsigned long resource, serial;
  unsigned char code, request, minor;
};
constexpr unsigned char kBadWindow = 3, kBadDrawable = 9;

constexpr std::size_t kMaxKeys = 64;  // between two frames

// A mark is moved on while an arrow is held; no other key means more when it is held.
bool repeats(int key) {
  return key == GLFW_KEY_LEFT || key == GLFW_KEY_RIGHT || key == GLFW_KEY_UP || key == GLFW_KEY_DOWN;
}

GamepadStand stand_of(const GLFWgamepadstate& s) {
  constexpr std::array<int, kButtons> kAs{GLFW_GAMEPAD_BUTTON_A,         GLFW_GAMEPAD_BUTTON_B,
                                          GLFW_GAMEPAD_BUTTON_X,         GLFW_GAMEPAD_BUTTON_Y,
                                          GLFW_GAMEPAD_BUTTON_DPAD_LEFT, GLFW_GAMEPAD_BUTTON_DPAD_RIGHT,
                                          GLFW_GAMEPAD_BUTTON_DPAD_UP,   GLFW_GAMEPAD_BUTTON_DPAD_DOWN};
  GamepadStand out;
  for (std::size_t i = 0; i < kButtons; ++i) out.held[i] = s.buttons[kAs[i]] == GLFW_PRESS;
  out.sticks = {{{s.axes[GLFW_GAMEPAD_AXIS_LEFT_X], s.axes[GLFW_GAMEPAD_AXIS_LEFT_Y]},
                 {s.axes[GLFW_GAMEPAD_AXIS_RIGHT_X], s.axes[GLFW_GAMEPAD_AXIS_RIGHT_Y]}}};
  return out;
}

class Window : public Display {
 public:
  Window(const std::string& title, const WindowOptions& o) : windowed_width_(o.width), windowed_height_(o.height) {
    if (!glfwInit()) refuse();
    choose_monitor(o.monitor);
    stay_on_monitor();
    // EGL knows no buffers for two eyes; the desktop's own contexts may.
    if (o.quad_buffer) open(title, o, GLFW_NATIVE_CONTEXT_API, true);
    if (!window_) {
      if (o.quad_buffer)
        trouble_ += std::string(trouble_.empty() ? "" : "; ") +
                    "this display has no buffer for each eye; both eyes are shown side by side";
      open(title, o, GLFW_EGL_CONTEXT_API, false);
    }
    if (!window_) refuse();
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(0);  // the loop has its own pace and waits for no screen
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
    survive_the_server();
    description_ = std::string(reinterpret_cast<const char*>(glGetString(GL_RENDERER))) + " in a window";
    if (o.full_screen) toggle_full_screen();
  }
  ~Window() override {
    if (!lost_) glfwTerminate();  // what is asked of a display server that is gone ends the process
  }

  void show(unsigned framebuffer, int width, int height, bool halves) override {
    if (!lost_ && !(lost_ = server_hung_up())) guard_.during([&] { put(framebuffer, width, height, halves); });
  }
  bool closed() override {
    return !lost_ && (glfwWindowShouldClose(window_) || (x11_window_ != 0 && destroyed_ == x11_window_));
  }
  std::string lost() override {
    return lost_ ? "the display server of the window is gone" : why_context_is_lost();
  }
  bool server_gone() override { return lost_; }
  bool has_screen() const override { return true; }

  Inputs take_inputs() override {
    Inputs inputs;
    guard_.during([&] { inputs = inputs_now(); });
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
      trouble_ = "no monitor is known: the window stays as it is";
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
    // What is iconified or has no size shows nothing; a desktop may let its swap wait until it is seen again.
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
        gamepads_[static_cast<std::size_t>(i)].forget();
        continue;
      }
      const auto pressed = gamepads_[static_cast<std::size_t>(i)].pressed(stand_of(state));
      all.insert(all.end(), pressed.begin(), pressed.end());
    }
    return all;
  }

  void choose_monitor(int number) {
    int count = 0;
    GLFWmonitor** monitors = glfwGetMonitors(&count);
    if (count == 0) return;
    if (number >= count)
      trouble_ = "there is no monitor " + std::to_string(number) + "; the last of " + std::to_string(count) +
                 ", counted from 0, is taken";
    monitor_ = monitors[std::clamp(number, 0, count - 1)];
  }

  // A software renderer needs memory for all of a window, seen or not.
  void stay_on_monitor() {
    const GLFWvidmode* mode = monitor_ ? glfwGetVideoMode(monitor_) : nullptr;
    const int most_width = mode ? mode->width : 4096, most_height = mode ? mode->height : 4096;
    if (windowed_width_ > most_width || windowed_height_ > most_height)
      trouble_ += std::string(trouble_.empty() ? "" : "; ") +
                  "the window is larger than its monitor: it is made " +
                  std::to_string(std::min(windowed_width_, most_width)) + " x " +
                  std::to_string(std::min(windowed_height_, most_height)) + " pixels";
    windowed_width_ = std::clamp(windowed_width_, 1, most_width);
    windowed_height_ = std::clamp(windowed_height_, 1, most_height);
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

  // Xlib says why and ends the process when its server goes away, unless both are led elsewhere. It is in GLFW's
  // hands: found, not linked.
  void survive_the_server() {
    using ErrorHandler = int (*)(void*);
    using ExitHandler = void (*)(void*, void*);
    using SetProtocol = void* (*)(int (*)(void*, const ProtocolError*));
    using SetError = ErrorHandler (*)(ErrorHandler);
    using SetExit = void (*)(void*, ExitHandler, void*);
    void* library = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
    if (!library) return;  // a desktop without it
    const auto set_error = reinterpret_cast<SetError>(dlsym(library, "XSetIOErrorHandler"));
    const auto set_exit = reinterpret_cast<SetExit>(dlsym(library, "XSetIOErrorExitHandler"));
    void* display = set_error && set_exit ? glfwGetX11Display() : nullptr;
    if (!display) return;
    x11_window_ = glfwGetX11Window(window_);
    using Number = int (*)(void*);
    if (const auto number = reinterpret_cast<Number>(dlsym(library, "XConnectionNumber")))
      connection_ = number(display);
    set_error([](void*) { return 0; });
    // Likewise an error of a window that another program has destroyed.
    const auto set_protocol = reinterpret_cast<SetProtocol>(dlsym(library, "XSetErrorHandler"));
    if (set_protocol)
      set_protocol([](void*, const ProtocolError* e) {
        if (e->code == kBadWindow || e->code == kBadDrawable) destroyed_ = e->resource;
        return 0;
      });
    set_exit(
        display, [](void*, void* window) { static_cast<Window*>(window)->lost_ = true; }, this);
  }

  // Asked before every swap: Mesa's never ends once the connection is known to be broken.
  bool server_hung_up() const {
    if (connection_ < 0) return false;
    pollfd fd{connection_, 0, 0};
    return ::poll(&fd, 1, 0) > 0 && (fd.revents & (POLLHUP | POLLERR | POLLNVAL));
  }

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
  GLFWmonitor* monitor_ = nullptr;
  bool quad_ = false, lost_ = false;
  CallGuard guard_;
  int connection_ = -1;                        // to the X server
  unsigned long x11_window_ = 0;               // 0: another desktop
  static inline unsigned long destroyed_ = 0;  // Xlib hands its handler nothing to know us by
  int windowed_x_ = 0, windowed_y_ = 0, windowed_width_, windowed_height_;
  std::vector<int> keys_;
  // Where the mouse was by the same events that say whether it is held. glfwGetCursorPos asks the server where it
  // is now, when it may have been let go and moved on already: only for a mouse that has not moved yet, or whose
  // window has moved under it, which no event of the mouse tells.
  std::optional<std::array<double, 2>> cursor_;
  std::array<Gamepad, GLFW_JOYSTICK_LAST + 1> gamepads_;
};

}  // namespace

std::unique_ptr<Display> make_window(const std::string& title, const WindowOptions& options) {
  return std::make_unique<Window>(title, options);
}

}  // namespace tactus::visual
