// The files of rooms/, embedded in the library.
#pragma once

#include <string_view>

namespace tactus::visual {

// Text of a file in rooms/, e.g. "cave4.csv"; empty when there is none of that name.
std::string_view room_text(std::string_view file);

}  // namespace tactus::visual
