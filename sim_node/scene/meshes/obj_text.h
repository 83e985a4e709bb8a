// The text of an OBJ or MTL file in the form that Assimp reads completely. Pure.
#pragma once

#include <string>

namespace tactus::sim {

// Removes the byte order mark of UTF-8, with which Assimp loses the first line, and writes numbers that begin with a point with a
// zero (.5 as 0.5): Assimp takes a vertex of such numbers for an empty line, so that later faces name wrong vertices. Returns
// whether the text changed.
bool complete_obj_text(std::string& text);

}  // namespace tactus::sim
