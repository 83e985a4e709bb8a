// Polls a shader folder on its own thread, since reading a remote folder may take long.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "visual_node/gl/shader_library.h"

namespace tactus::visual {

// The files *.frag, *.vert and *.glsl of a folder, at most 64 files of 64 kB each: others are ignored.
ShaderFolder read_shader_folder(const std::string& folder);

class ShaderWatch {
 public:
  // An empty name: no folder, and no thread.
  explicit ShaderWatch(const std::string& folder);
  ~ShaderWatch();
  // Returns the content of the folder if it has changed since the last call; it is at most half a second old.
  // Never blocks.
  std::optional<ShaderFolder> take_change();

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
  std::jthread thread_;
};

}  // namespace tactus::visual
