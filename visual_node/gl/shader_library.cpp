#include "visual_node/gl/shader_library.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>
#include <string_view>

#include "visual_node/gl/shader_text.h"

namespace tactus::visual {
namespace {

// Names of looks that phong.frag draws, when the look has the maps or the mirror.
constexpr std::array<std::string_view, 3> kPhongAliases{"normal_mapped", "textured", "reflecting"};
constexpr const char* kShaderNames =
    "phong, gouraud, normal_mapped, textured, reflecting; passes greyscale, blur, edges";

std::string base_name(const std::string& file) { return std::filesystem::path(file).filename().string(); }

}  // namespace

const ShaderText* ShaderLibrary::scene_shader(const std::string& name) const {
  const auto found =
      std::find_if(scene_shaders_.begin(), scene_shaders_.end(), [&](const ShaderText& s) { return s.name == name; });
  return found == scene_shaders_.end() ? nullptr : &*found;
}

std::optional<ShaderPiece> ShaderLibrary::find(const std::string& file, const std::string& text) const {
  if (const auto edited = folder_.find(file); !file.empty() && edited != folder_.end())
    return ShaderPiece{file, edited->second};
  if (!text.empty()) return ShaderPiece{file, text};
  return {};
}

std::optional<ShaderPiece> ShaderLibrary::fragment(const std::string& name) const {
  if (const ShaderText* s = scene_shader(name))
    return find(s->fragment_file.empty() ? name + ".frag" : base_name(s->fragment_file), s->fragment);
  if (auto edited = find(name + ".frag", "")) return edited;
  const bool phong = std::find(kPhongAliases.begin(), kPhongAliases.end(), name) != kPhongAliases.end();
  const std::string file = (phong ? "phong" : name) + ".frag";
  const std::string_view own = shader_text(file);
  // Internal shaders and pieces without shade() are not looks.
  if (own.find("vec4 shade()") == std::string_view::npos) return {};
  return find(file, std::string(own));
}

std::optional<ShaderPiece> ShaderLibrary::vertex(const std::string& name) const {
  if (const ShaderText* s = scene_shader(name); s && !(s->vertex.empty() && s->vertex_file.empty()))
    return find(s->vertex_file.empty() ? name + ".vert" : base_name(s->vertex_file), s->vertex);
  return find(name + ".vert", "");
}

ShaderPiece ShaderLibrary::source_file(const std::string& file) const {
  const auto piece = find(file, std::string(shader_text(file)));
  if (!piece) throw std::runtime_error("there is no shader " + file);
  return *piece;
}

std::string ShaderLibrary::names() const {
  std::string all = kShaderNames;
  for (const ShaderText& s : scene_shaders_) all += ", " + s.name;
  return all;
}

}  // namespace tactus::visual
