// Whether the numbers that a scene gives a shader are numbers that it takes.
#pragma once

#include <string>
#include <tactus/uniform_t.hpp>
#include <vector>

#include "visual_node/gl/shader_library.h"

namespace tactus::visual {

// One sentence for each that the program of the shader of that name would leave aside: its text does not know the
// name, or has something else by that name.
std::vector<std::string> misfits(const ShaderLibrary& library, const std::string& shader, const Program& program,
                                 const std::vector<uniform_t>& uniforms);

}  // namespace tactus::visual
