// Looks of surfaces as the scene defines them: shaders, maps and numbers, with the files that they name.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tactus/pass_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/uniform_t.hpp>
#include <vector>

#include "sync/assets/scene_receiver.h"
#include "sync/pictures/confined_pictures.h"
#include "sync/pictures/raster.h"

namespace tactus::visual {

// The files of looks, passes and the environment, by content hash.
struct LookFiles {
  std::map<std::int64_t, sync::Raster> pictures;
  std::map<std::int64_t, std::string> texts;
};

// Decodes them in a confined process. Adds one sentence to `warnings` for each missing or damaged file.
LookFiles look_files_of(const sync::SceneReceiver& scenes, sync::ConfinedPictures& reader, std::vector<std::string>& warnings);

// The sources of a shader; empty: the built-in source of the stage.
struct ShaderText {
  std::string name, fragment, vertex;
  std::string fragment_file, vertex_file;  // for messages, and for a user who edits them
};

struct Look {
  std::string name;
  std::string shader = "phong";
  int colour_map = -1, normal_map = -1;  // index in Appearance::pictures
  float reflectance = 0;                 // at normal incidence; 0: no mirror
  bool translucent = false;
  std::vector<uniform_t> uniforms;
  bool mapped() const { return colour_map >= 0 || normal_map >= 0; }
};

// All looks and their files for the renderer. The first look is that of surfaces without a look.
struct Appearance {
  std::vector<Look> looks{Look{}};
  std::vector<sync::Raster> pictures;
  std::vector<ShaderText> shaders;  // shaders of the scene
  std::vector<pass_t> passes;
  int environment = -1;  // index in pictures; -1: the background colour
};

// The appearance of a scene: look i of the scene is looks[i + 1]. A picture that is missing among the files is left
// out.
Appearance make_appearance(const scene_t& scene, LookFiles files);

}  // namespace tactus::visual
