// The texts of shaders by name: from a folder that somebody works in, from the scene, or as they come. Pure.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "visual_node/gl/program.h"
#include "visual_node/scene_view/look.h"

namespace tactus::visual {

using ShaderFolder = std::map<std::string, std::string>;  // text by file name

class ShaderLibrary {
 public:
  explicit ShaderLibrary(std::vector<ShaderText> of_scene = {}) : of_scene_(std::move(of_scene)) {}

  // What is in the folder now. A file there takes the place of the one of its name that came with the scene or the
  // node.
  void set(ShaderFolder folder) { folder_ = std::move(folder); }

  // The fragment shader of that name, or nothing when there is none.
  std::optional<ShaderPiece> fragment(const std::string& name) const;
  // Its vertex shader where it has one of its own.
  std::optional<ShaderPiece> vertex(const std::string& name) const;
  // A file of shaders/, or the folder's in its place.
  ShaderPiece own(const std::string& file) const;
  // Names that looks and passes may use, for messages.
  std::string names() const;

 private:
  std::optional<ShaderPiece> find(const std::string& file, const std::string& text) const;
  const ShaderText* scene_shader(const std::string& name) const;
  std::vector<ShaderText> of_scene_;
  ShaderFolder folder_;
};

}  // namespace tactus::visual
