// Passes over the whole picture, one after the other, by shaders that the scene names.
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
  // One sentence in `trouble` for each that cannot be made; it is left out.
  ScreenPasses(const ShaderLibrary& library, const std::vector<pass_t>& passes, int width, int height,
               std::vector<std::string>& trouble);
  // Shaders have changed. One that cannot be made anew stays as it was.
  void reload(const ShaderLibrary& library, std::vector<std::string>& trouble);

  // Afterwards the picture is what they made of it.
  void draw(const PictureTarget& picture);

 private:
  void make(const ShaderLibrary& library, std::vector<std::string>& trouble);
  std::vector<pass_t> passes_;
  std::vector<std::unique_ptr<Program>> programs_;  // null: left out
  std::unique_ptr<PictureTarget> other_;            // null: there are none
  std::unique_ptr<QuadArray> quad_;
};

}  // namespace tactus::visual
