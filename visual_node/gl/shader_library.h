// Shader sources by name: from the user's shader folder, from the scene, or built in. Pure.
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
  explicit ShaderLibrary(std::vector<ShaderText> scene_shaders = {}) : scene_shaders_(std::move(scene_shaders)) {}

  // Sets the content of the folder. Its files replace files of the same name of the scene or the node.
  void set(ShaderFolder folder) { folder_ = std::move(folder); }

  // The fragment shader of that name; nothing when there is none.
  std::optional<ShaderPiece> fragment(const std::string& name) const;
  // Its vertex shader, if it has one of its own.
  std::optional<ShaderPiece> vertex(const std::string& name) const;
  // A file of shaders/, or its replacement from the folder.
  ShaderPiece source_file(const std::string& file) const;
  // Names that looks and passes may use, for messages.
  std::string names() const;

 private:
  std::optional<ShaderPiece> find(const std::string& file, const std::string& text) const;
  const ShaderText* scene_shader(const std::string& name) const;
  std::vector<ShaderText> scene_shaders_;
  ShaderFolder folder_;
};

}  // namespace tactus::visual
