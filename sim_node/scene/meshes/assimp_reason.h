// Why assimp does not read a file, in words of the user. Thread-safe: yes.
#pragma once

#include <filesystem>
#include <string>

namespace tactus::sim {

inline constexpr char kNoSurface[] = "it holds no surface, neither a triangle nor a polygon; export it with faces";

// A clause for "FILE cannot be read: ...", with the remedy. text: Assimp::Importer::GetErrorString(). A text of assimp that has no clause of
// its own stands in parentheses, without the path and line breaks, and at most 160 bytes long.
std::string assimp_reason(const std::filesystem::path& file, const std::string& text);

}  // namespace tactus::sim
