// The programs of all kinds of surfaces of a scene. A program that cannot be rebuilt keeps its previous version; a
// program that was never built is replaced by that of the first look.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "visual_node/gl/surface_program.h"

namespace tactus::visual {

class SurfacePrograms {
 public:
  SurfacePrograms() = default;
  // Adds one sentence to `warnings` for each look whose shader cannot be used. Throws std::runtime_error when that
  // is the first look.
  SurfacePrograms(const ShaderLibrary& library, const std::vector<Look>& looks, const Lighting& lighting,
                  bool reliefs, std::vector<std::string>& warnings);

  // Rebuilds all programs after a change of shaders.
  void reload(const ShaderLibrary& library, std::vector<std::string>& warnings);

  int looks() const { return static_cast<int>(looks_.size()); }
  const Look& look(int index) const { return looks_[valid_index(index)]; }
  const Program& program(int look, bool relief, bool shadows) const;
  // Calls each(program, look) once for each program with or without shadows.
  template <class Each>
  void for_each(bool shadows, Each each) const {
    for (std::size_t i = 0; i < looks_.size(); ++i)
      for (const bool relief : {false, true})
        if (const auto& p = programs_[index(i, relief, shadows)]) each(*p, looks_[i]);
  }

 private:
  static std::size_t index(std::size_t look, bool relief, bool shadows) { return 4 * look + 2 * relief + shadows; }
  std::size_t valid_index(int look) const {
    return look >= 0 && look < static_cast<int>(looks_.size()) ? static_cast<std::size_t>(look) : 0;
  }
  void make(const ShaderLibrary& library, std::vector<std::string>& warnings);

  std::vector<Look> looks_;
  Lighting lighting_;
  bool reliefs_ = false;
  std::vector<std::unique_ptr<Program>> programs_;
};

}  // namespace tactus::visual
