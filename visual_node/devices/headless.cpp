#include <pwd.h>
#include <unistd.h>

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <malloc.h>

#include <array>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "visual_node/devices/context_loss.h"
#include "visual_node/devices/display.h"

namespace tactus::visual {
namespace {

struct Candidate {
  std::string name;
  EGLDisplay display;
};

class Headless : public Display {
 public:
  Headless(EGLDisplay display, EGLContext context, const std::string& name)
      : display_(display), context_(context) {
    description_ = std::string(reinterpret_cast<const char*>(glGetString(GL_RENDERER))) + " on " + name;
  }
  ~Headless() override {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglTerminate(display_);
  }
  void show(unsigned, int, int, bool) override {}
  bool closed() override { return false; }
  std::string loss_reason() override { return context_loss_reason(); }
  bool has_screen() const override { return false; }

 private:
  EGLDisplay display_;
  EGLContext context_;
};

std::string error_text() {
  std::ostringstream text;
  text << "0x" << std::hex << eglGetError();
  return text.str();
}

bool has_client_extension(const char* name) { return epoxy_has_egl_extension(EGL_NO_DISPLAY, name); }

std::vector<Candidate> candidates(int egl_device) {
  std::vector<Candidate> list;
  if (has_client_extension("EGL_EXT_platform_device") &&
      (has_client_extension("EGL_EXT_device_enumeration") || has_client_extension("EGL_EXT_device_base"))) {
    std::array<EGLDeviceEXT, 64> devices{};
    EGLint count = 0;
    eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count);
    const auto add = [&](int i) {
      list.push_back(
          {"EGL device " + std::to_string(i),
           eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr)});
    };
    if (egl_device >= 0 && egl_device < count) add(egl_device);
    for (int i = 0; i < count; ++i)
      if (i != egl_device) add(i);
  }
  if (has_client_extension("EGL_MESA_platform_surfaceless"))
    list.push_back({"EGL surfaceless",
                    eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)});
  list.push_back({"EGL default display", eglGetDisplay(EGL_DEFAULT_DISPLAY)});
  return list;
}

// Returns null, with the cause in `reason`, when this candidate has no suitable context.
std::unique_ptr<Display> try_candidate(const Candidate& c, std::string& reason) {
  if (c.display == EGL_NO_DISPLAY) return reason = "no such display", nullptr;
  if (!eglInitialize(c.display, nullptr, nullptr))
    return reason = "eglInitialize failed, " + error_text(), nullptr;
  const auto reject = [&](const std::string& why) {
    reason = why + ", " + error_text();
    eglTerminate(c.display);
    return nullptr;
  };
  if (!epoxy_has_egl_extension(c.display, "EGL_KHR_surfaceless_context"))
    return reject("no contexts without a surface");
  if (!eglBindAPI(EGL_OPENGL_API)) return reject("no OpenGL");
  // A context that reports its loss, if the driver supports that; otherwise the last two attributes are left out.
  std::array<EGLint, 9> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                   3,
                                   EGL_CONTEXT_MINOR_VERSION,
                                   3,
                                   EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                   EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                   EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                                   EGL_LOSE_CONTEXT_ON_RESET,
                                   EGL_NONE};
  EGLConfig config = nullptr;  // EGL_NO_CONFIG_KHR
  if (!epoxy_has_egl_extension(c.display, "EGL_KHR_no_config_context")) {
    constexpr std::array<EGLint, 3> any{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLint found = 0;
    if (!eglChooseConfig(c.display, any.data(), &config, 1, &found) || found == 0)
      return reject("no OpenGL configuration");
  }
  EGLContext context = eglCreateContext(c.display, config, EGL_NO_CONTEXT, attributes.data());
  if (context == EGL_NO_CONTEXT) {
    attributes[6] = EGL_NONE;
    context = eglCreateContext(c.display, config, EGL_NO_CONTEXT, attributes.data());
  }
  if (context == EGL_NO_CONTEXT) return reject("no OpenGL 3.3 core context");
  if (!eglMakeCurrent(c.display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    eglDestroyContext(c.display, context);
    return reject("its context cannot be made current");
  }
  return std::make_unique<Headless>(c.display, context, c.name);
}

}  // namespace

void configure_software_renderer() {
  setenv("LP_NUM_THREADS", "1", 0);
  // The renderer allocates and frees some MB in blocks of 64 KiB for every picture. With these thresholds malloc
  // keeps the memory, so the kernel does not clear and map it again, which took a quarter of the time. The second
  // value is the maximum of malloc; both are far above the needs of a picture.
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  // Mesa stores compiled shaders in the home folder of the password file and complains when it cannot write
  // there: in a user namespace that is the home of root.
  const passwd* me = getpwuid(getuid());
  const bool cache_set = std::getenv("XDG_CACHE_HOME") || std::getenv("MESA_SHADER_CACHE_DIR");
  if (!cache_set && (me == nullptr || access(me->pw_dir, W_OK) != 0)) setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
  setenv("EGL_LOG_LEVEL", "fatal", 0);  // our own message names the failures
}

namespace {

// The remedy that fits this machine: the packages of the software renderer where it is missing, else the variables of the
// environment that choose another one.
std::string renderer_advice() {
  if (!dlopen("libEGL_mesa.so.0", RTLD_LAZY)) return "install libegl-mesa0 and libgl1-mesa-dri for a software renderer";
  std::string chosen;
  for (char** entry = environ; *entry; ++entry) {
    const std::string_view text = *entry;
    const std::string_view name = text.substr(0, text.find('='));
    for (const std::string_view prefix : {"__EGL_", "EGL_PLATFORM", "LIBGL_", "MESA_GL_", "MESA_LOADER_", "GALLIUM_"})
      if (name.starts_with(prefix)) chosen += (chosen.empty() ? "" : ", ") + std::string(name);
  }
  return "the software renderer libegl-mesa0 is installed, but " +
         (chosen.empty() ? "does not start; read the output of eglinfo (mesa-utils)" : "variables choose another; unset " + chosen);
}

}  // namespace

std::unique_ptr<Display> make_headless(int egl_device) {
  // libepoxy would abort the process without this library.
  if (!dlopen("libEGL.so.1", RTLD_LAZY | RTLD_GLOBAL))
    throw std::runtime_error("libEGL.so.1 is missing; install libegl1, libegl-mesa0 and libgl1-mesa-dri");
  std::string tried;
  for (const Candidate& c : candidates(egl_device)) {
    std::string reason;
    if (auto display = try_candidate(c, reason)) return display;
    tried += (tried.empty() ? "" : "; ") + c.name + " (" + reason + ")";
  }
  throw std::runtime_error("no OpenGL 3.3 context, tried " + tried + "; " + renderer_advice());
}

}  // namespace tactus::visual
