#include "visual_node/gl/surface_programs.h"

#include <array>
#include <stdexcept>
#include <utility>

#include "visual_node/gl/uniforms.h"

namespace tactus::visual {
namespace {

// Prefix of messages. Looks without a name are called "look 6" by the scene.
std::string message_prefix(const Look& look) {
  if (look.name.empty()) return "";
  return (look.name.starts_with("look ") ? "" : "look ") + look.name + ": ";
}

}  // namespace

SurfacePrograms::SurfacePrograms(const ShaderLibrary& library, const std::vector<Look>& looks,
                                 const Lighting& lighting, bool reliefs, std::vector<std::string>& warnings)
    : looks_(looks), lighting_(lighting), reliefs_(reliefs), programs_(4 * looks.size()) {
  make(library, warnings);
  if (!programs_.front()) throw std::runtime_error(warnings.empty() ? "no surface can be drawn" : warnings.back());
}

void SurfacePrograms::reload(const ShaderLibrary& library, std::vector<std::string>& warnings) {
  make(library, warnings);
}

void SurfacePrograms::make(const ShaderLibrary& library, std::vector<std::string>& warnings) {
  Lighting plain = lighting_;
  plain.shadow_light = -1;
  for (std::size_t i = 0; i < looks_.size(); ++i) try {
      // Rebuild all programs of a look or none, so that its appearance does not depend on the shadows.
      std::array<std::unique_ptr<Program>, 4> fresh;
      for (const bool relief : {false, true})
        for (const bool shadows : {false, true})
          if ((!relief || reliefs_) && (!shadows || lighting_.shadow_light >= 0))
            fresh[index(0, relief, shadows)] =
                surface_program(library, looks_[i], relief, shadows ? lighting_ : plain);
      for (const std::string& message :
           uniform_mismatches(library, looks_[i].shader, *fresh.front(), looks_[i].uniforms))
        warnings.push_back(message_prefix(looks_[i]) + message);
      for (std::size_t k = 0; k < fresh.size(); ++k) programs_[4 * i + k] = std::move(fresh[k]);
    } catch (const std::exception& e) {
      const bool before = programs_[index(i, false, false)] != nullptr;
      warnings.push_back(message_prefix(looks_[i]) + e.what() +
                         (before ? "; the previous shader stays in use" : "; phong is drawn instead"));
    }
}

const Program& SurfacePrograms::program(int look, bool relief, bool shadows) const {
  relief = relief && reliefs_, shadows = shadows && lighting_.shadow_light >= 0;
  if (const auto& p = programs_[index(valid_index(look), relief, shadows)]) return *p;
  return *programs_[index(0, relief, shadows)];
}

}  // namespace tactus::visual
