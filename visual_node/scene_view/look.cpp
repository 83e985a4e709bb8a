#include "visual_node/scene_view/look.h"

#include <stdexcept>
#include <tactus/shader_t.hpp>

namespace tactus::visual {
namespace {

// Reflectance of glass and most non-metals: ((n - 1) / (n + 1))^2 for a refractive index n of 1.5 (Fresnel's
// equations at normal incidence; the default of glTF 2.0, 3.9.6).
constexpr float kReflectanceOfGlass = 0.04f;

}  // namespace

LookFiles look_files_of(const sync::SceneReceiver& scenes, sync::ConfinedPictures& reader, std::vector<std::string>& warnings) {
  LookFiles files;
  if (!scenes.scene()) return files;
  const auto picture = [&](std::int64_t hash, const std::string& of) {
    if (hash == 0 || files.pictures.contains(hash)) return;
    const sync::Asset* asset = scenes.asset(hash);
    try {
      if (!asset) throw std::runtime_error("it was not sent");
      files.pictures.emplace(hash, reader.raster(asset->bytes));
    } catch (const std::exception& e) {
      warnings.push_back("the " + of + " cannot be read: " + e.what() + "; it is drawn without");
    }
  };
  const auto text = [&](std::int64_t hash, const std::string& of) {
    if (hash == 0 || files.texts.contains(hash)) return;
    if (const sync::Asset* asset = scenes.asset(hash))
      files.texts.emplace(hash, std::string(asset->bytes.begin(), asset->bytes.end()));
    else
      warnings.push_back("the text of shader " + of + " was not sent; phong is drawn instead");
  };
  for (const look_t& look : scenes.scene()->looks) {
    picture(look.colour_map, "colour map of look " + look.name);
    picture(look.normal_map, "normal map of look " + look.name);
  }
  picture(scenes.scene()->environment_asset, "picture of the environment");
  for (const shader_t& shader : scenes.scene()->shaders)
    text(shader.fragment_asset, shader.name), text(shader.vertex_asset, shader.name);
  return files;
}

Appearance make_appearance(const scene_t& scene, LookFiles files) {
  Appearance made;
  std::map<std::int64_t, int> index;
  const auto picture = [&](std::int64_t hash) {
    const auto found = files.pictures.find(hash);
    if (hash == 0 || found == files.pictures.end()) return -1;
    const auto [at, fresh] = index.try_emplace(hash, static_cast<int>(made.pictures.size()));
    if (fresh) made.pictures.push_back(std::move(found->second));
    return at->second;
  };
  for (const look_t& from : scene.looks) {
    Look look;
    look.name = from.name;
    if (!from.shader.empty()) look.shader = from.shader;
    look.colour_map = picture(from.colour_map);
    look.normal_map = picture(from.normal_map);
    look.reflectance = from.reflectance;
    if (look.shader == "reflecting" && look.reflectance == 0) look.reflectance = kReflectanceOfGlass;
    look.translucent =
        look.colour_map >= 0 && made.pictures[static_cast<std::size_t>(look.colour_map)].translucent;
    look.uniforms = from.uniforms;
    made.looks.push_back(std::move(look));
  }
  made.environment = picture(scene.environment_asset);
  const auto text = [&](std::int64_t hash) {
    const auto found = files.texts.find(hash);
    return found == files.texts.end() ? std::string() : found->second;
  };
  for (const shader_t& s : scene.shaders)
    made.shaders.push_back({s.name, text(s.fragment_asset), text(s.vertex_asset), s.fragment_file, s.vertex_file});
  made.passes = scene.passes;
  return made;
}

}  // namespace tactus::visual
