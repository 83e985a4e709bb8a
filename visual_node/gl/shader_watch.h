// Reads a folder of shaders again and again, off the loop: a folder may lie far away, and reading it take long.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "visual_node/gl/shader_library.h"

namespace tactus::visual {

// Its files *.frag, *.vert and *.glsl, at most 64 of 64 kB: others are left out.
ShaderFolder read_shader_folder(const std::string& folder);

class ShaderWatch {
 public:
  // Empty: no folder, and no thread.
  explicit ShaderWatch(const std::string& folder);
  ~ShaderWatch();
  // What is in the folder when that has changed since it was asked for last, half a second ago at most. Never
  // waits.
  std::optional<ShaderFolder> take();

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
  std::jthread thread_;
};

}  // namespace tactus::visual
