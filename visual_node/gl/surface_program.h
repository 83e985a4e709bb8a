// Builds the program of one kind of surface: a look, with or without relief, under the lamps of a scene.
#pragma once

#include <memory>

#include "visual_node/gl/program.h"
#include "visual_node/gl/shader_library.h"
#include "visual_node/scene_view/draw_list.h"
#include "visual_node/scene_view/look.h"

namespace tactus::visual {

// Texture units.
inline constexpr int kShadowUnit = 0, kReliefUnit = 1, kColourUnit = 2, kNormalUnit = 3, kEnvironmentUnit = 4;

// Throws std::runtime_error with one sentence when there is no shader of that name or it does not compile.
std::unique_ptr<Program> surface_program(const ShaderLibrary& library, const Look& look, bool relief,
                                         const Lighting& lighting);

}  // namespace tactus::visual
