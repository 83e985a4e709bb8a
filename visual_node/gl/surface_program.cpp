#include "visual_node/gl/surface_program.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

namespace tactus::visual {
namespace {

// One property of all lamps as a constant array of the shader; without lamps, one black entry.
std::string constant(const char* name, const Lighting& lighting, Eigen::Vector4f Light::*property) {
  std::string list;
  const auto add = [&](const Eigen::Vector4f& v) {
    char text[96];
    std::snprintf(text, sizeof text, "%svec4(%.9g, %.9g, %.9g, %.9g)", list.empty() ? "" : ", ",
                  static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z()),
                  static_cast<double>(v.w()));
    list += text;
  };
  for (const Light& l : lighting.lights) add(l.*property);
  if (lighting.lights.empty()) add(Eigen::Vector4f::Zero());
  return "#define " + std::string(name) + " vec4[](" + list + ")\n";
}

// The kinds of lamps and the features of the surface are compile-time constants of the shader: a software renderer
// pays for every branch of every pixel.
std::string defines(const Look& look, bool relief, bool moves, const Lighting& lighting) {
  std::string lamps;
  for (std::size_t i = 0; i < lighting.lights.size(); ++i) {
    const Light& l = lighting.lights[i];
    const std::string index = std::to_string(i);
    const bool shiny = l.specular.head<3>().maxCoeff() > 0;
    const auto flag = [](bool on) { return on ? ", true" : ", false"; };
    if (l.position.w() == 0)
      lamps += "directional(" + index + flag(shiny) + ");";
    else
      lamps += "lamp(" + index + flag(shiny) + flag(l.cone.x() != 0) + flag(l.cone.z() != 1) +
               flag(static_cast<int>(i) == lighting.shadow_light) + ");";
  }
  const auto define = [](const char* name, bool on) {
    return "#define " + std::string(name) + (on ? " 1\n" : " 0\n");
  };
  return "#define LIGHTS " + std::to_string(std::max<std::size_t>(1, lighting.lights.size())) +
         "\n#define LAMPS " + lamps + "\n" + constant("LAMP_DIFFUSE", lighting, &Light::diffuse) +
         constant("LAMP_SPECULAR", lighting, &Light::specular) +
         constant("LAMP_ATTENUATION", lighting, &Light::attenuation) +
         constant("LAMP_CONE", lighting, &Light::cone) + define("SHADOWS", lighting.shadow_light >= 0) +
         define("RELIEF", relief) + define("MAPPED", look.mapped()) + define("COLOUR_MAP", look.colour_map >= 0) +
         define("NORMAL_MAP", look.normal_map >= 0) + define("MIRROR", look.reflectance > 0) +
         define("GOURAUD", look.shader == "gouraud") + (moves ? "#define MOVES 1\n" : "");
}

}  // namespace

std::unique_ptr<Program> surface_program(const ShaderLibrary& library, const Look& look, bool relief,
                                         const Lighting& lighting) {
  const auto shade = library.fragment(look.shader);
  if (!shade) throw std::runtime_error("there is no shader " + look.shader + "; there are " + library.names());
  const auto moved = library.vertex(look.shader);
  std::vector<ShaderPiece> vertex{library.source_file("surface.vert")};
  if (look.shader == "gouraud") vertex.push_back(library.source_file("lamps.glsl"));
  if (moved) vertex.push_back(*moved);
  vertex.push_back(library.source_file("surface_end.vert"));
  const std::vector<ShaderPiece> fragment{library.source_file("surface.glsl"), library.source_file("lamps.glsl"),
                                          library.source_file("shade.glsl"), *shade,
                                          library.source_file("surface_end.frag")};
  auto program = std::make_unique<Program>(vertex, fragment, defines(look, relief, moved.has_value(), lighting));
  if (const unsigned block = glGetUniformBlockIndex(program->id(), "Lights"); block != GL_INVALID_INDEX)
    glUniformBlockBinding(program->id(), block, 0);
  return program;
}

}  // namespace tactus::visual
