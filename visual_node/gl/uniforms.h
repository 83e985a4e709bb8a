// Checks the uniforms that a scene sets against those of the shader.
#pragma once

#include <string>
#include <tactus/uniform_t.hpp>
#include <vector>

#include "visual_node/gl/shader_library.h"

namespace tactus::visual {

// One sentence for each uniform that the program of this shader would ignore: its source does not contain the name,
// or declares another type by that name.
std::vector<std::string> uniform_mismatches(const ShaderLibrary& library, const std::string& shader,
                                            const Program& program, const std::vector<uniform_t>& uniforms);

}  // namespace tactus::visual
