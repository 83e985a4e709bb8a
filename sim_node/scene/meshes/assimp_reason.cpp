#include "sim_node/scene/meshes/assimp_reason.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace tactus::sim {
namespace {

struct AssimpClause {
  std::string_view words;  // of assimp
  std::string_view reason;
};

constexpr std::string_view kCutOff = "it is empty or cut off; export it again";
constexpr std::string_view kUnknownFormat = "its format is not known; give glTF, OBJ, STL, PLY or COLLADA, with the ending of its format";

// Of the versions 5.0 to 5.4 of assimp.
constexpr AssimpClause kAssimpClauses[] = {
    {"No meshes", kNoSurface},
    {"no meshes", kNoSurface},
    {"invalid primitive type", kNoSurface},
    {"does not contain any mesh", kNoSurface},
    {"Unable to extract mesh data", kNoSurface},
    {"file is too small", kCutOff},
    {"File is too small", kCutOff},
    {"File is empty", kCutOff},
    {"Unexpected end of file", kCutOff},
    {"Unexpected EOF", kCutOff},
    {"End of file", kCutOff},
    {"No suitable reader found", kUnknownFormat},
    {"Failed to determine STL", "it is no STL file, neither text nor binary; export it again"},
    {"Incorrect magic number", "it does not begin with the word ply, as a PLY file does; export it again, or correct the ending of its name"},
    {"vertex index out of range", "a face names a vertex that the file does not hold; export it again"},
    {"Expected different index count", "a <p> holds another number of indices than its <triangles> or <polylist>; export it again"},
    {"Expected more values", "an array holds fewer values than its count; export it again"},
    {"as a real number", "a text stands where a number belongs; correct it, or export it again"},
    {"Unable to open file", "it does not exist, or this user may not read it; correct the name or its permissions"},
    {"Failed to open file", "it does not exist, or this user may not read it; correct the name or its permissions"},
    {"bad allocation", "there is not enough memory for it; simplify it"},
};

// One line without the path of the file, which the caller names.
std::string assimp_detail(const std::filesystem::path& file, std::string text) {
  for (const std::string& path : {file.string(), file.filename().string()})
    for (std::size_t at; !path.empty() && (at = text.find(path)) != std::string::npos;) text.erase(at, path.size());
  for (char& c : text)
    if (!std::isprint(static_cast<unsigned char>(c))) c = ' ';
  constexpr std::size_t kMaxDetail = 160;
  if (text.size() > kMaxDetail) text.resize(kMaxDetail);
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text;
}

}  // namespace

std::string assimp_reason(const std::filesystem::path& file, const std::string& text) {
  for (const AssimpClause& clause : kAssimpClauses)
    if (text.find(clause.words) != std::string::npos) return std::string(clause.reason);
  const std::string more = assimp_detail(file, text);
  return "its contents are not those of a " + file.extension().string() + " file" + (more.empty() ? "" : " (" + more + ")") +
         "; export it again, or as glTF";
}

}  // namespace tactus::sim
