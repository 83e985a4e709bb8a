#include "visual_node/gl/uniforms.h"

#include <epoxy/gl.h>

#include <array>

namespace tactus::visual {
namespace {

constexpr std::array<unsigned, 4> kTypes{GL_FLOAT, GL_FLOAT_VEC2, GL_FLOAT_VEC3, GL_FLOAT_VEC4};
constexpr std::array<const char*, 4> kTypeNames{"a float", "a vec2", "a vec3", "a vec4"};

}  // namespace

std::vector<std::string> uniform_mismatches(const ShaderLibrary& library, const std::string& shader,
                                            const Program& program, const std::vector<uniform_t>& uniforms) {
  std::vector<std::string> sentences;
  const auto fragment = library.fragment(shader), vertex = library.vertex(shader);
  for (const uniform_t& u : uniforms) {
    if (u.count < 1 || u.count > 4) continue;  // rejected where messages arrive
    const char* name = u.name.c_str();
    unsigned index = GL_INVALID_INDEX;
    glGetUniformIndices(program.id(), 1, &name, &index);
    if (index == GL_INVALID_INDEX) {
      // The compiler removes uniforms without effect.
      if ((fragment && fragment->text.find(u.name) != std::string::npos) ||
          (vertex && vertex->text.find(u.name) != std::string::npos))
        continue;
      sentences.push_back("shader " + shader + " has no uniform " + u.name + "; it is ignored");
      continue;
    }
    int type = 0;
    glGetActiveUniformsiv(program.id(), 1, &index, GL_UNIFORM_TYPE, &type);
    const auto given = static_cast<std::size_t>(u.count - 1);
    if (static_cast<unsigned>(type) != kTypes[given])
      sentences.push_back("uniform " + u.name + " of shader " + shader + " is not " + kTypeNames[given] + ", and " +
                     std::to_string(u.count) + (u.count == 1 ? " number is" : " numbers are") +
                     " given; it is ignored");
  }
  return sentences;
}

}  // namespace tactus::visual
