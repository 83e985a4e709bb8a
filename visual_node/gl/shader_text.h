// The files of shaders/, embedded in the library.
#pragma once

#include <string_view>

namespace tactus::visual {

// Text of a file in shaders/, e.g. "surface.frag"; empty when there is none of that name.
std::string_view shader_text(std::string_view file);

}  // namespace tactus::visual
