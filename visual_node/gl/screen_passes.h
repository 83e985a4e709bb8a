// Screen passes: shaders named by the scene that process the whole picture, one after the other.
#pragma once

#include <memory>
#include <string>
#include <tactus/pass_t.hpp>
#include <vector>

#include "visual_node/gl/buffers.h"
#include "visual_node/gl/shader_library.h"

namespace tactus::visual {

class ScreenPasses {
 public:
  ScreenPasses() = default;
  // Adds one sentence to `warnings` for each pass that cannot be built; that pass is left out.
  ScreenPasses(const ShaderLibrary& library, const std::vector<pass_t>& passes, int width, int height,
               std::vector<std::string>& warnings);
  // Rebuilds the passes after a change of shaders. A pass that cannot be built keeps its previous version.
  void reload(const ShaderLibrary& library, std::vector<std::string>& warnings);

  // Replaces the picture by the result of the passes.
  void draw(const PictureTarget& picture);

 private:
  void make(const ShaderLibrary& library, std::vector<std::string>& warnings);
  std::vector<pass_t> passes_;
  std::vector<std::unique_ptr<Program>> programs_;  // null: left out
  std::unique_ptr<PictureTarget> other_;            // null: no passes
  std::unique_ptr<QuadArray> quad_;
};

}  // namespace tactus::visual
