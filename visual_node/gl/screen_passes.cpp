#include "visual_node/gl/screen_passes.h"

#include <epoxy/gl.h>

#include <array>
#include <stdexcept>
#include <tactus/uniform_t.hpp>
#include <utility>

#include "visual_node/gl/uniforms.h"

namespace tactus::visual {

ScreenPasses::ScreenPasses(const ShaderLibrary& library, const std::vector<pass_t>& passes, int width, int height,
                           std::vector<std::string>& warnings)
    : passes_(passes), programs_(passes.size()) {
  if (passes.empty()) return;
  other_ = std::make_unique<PictureTarget>(width, height);
  quad_ = std::make_unique<QuadArray>(1);
  make(library, warnings);
}

void ScreenPasses::reload(const ShaderLibrary& library, std::vector<std::string>& warnings) {
  make(library, warnings);
}

void ScreenPasses::make(const ShaderLibrary& library, std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < passes_.size(); ++i) try {
      const auto shade = library.fragment(passes_[i].shader);
      if (!shade)
        throw std::runtime_error("there is no shader " + passes_[i].shader + "; there are " + library.names());
      programs_[i] = std::make_unique<Program>(
          std::vector{library.source_file("pass.vert")},
          std::vector{library.source_file("pass.glsl"), *shade, library.source_file("pass_end.frag")}, "");
      for (const std::string& misfit :
           uniform_mismatches(library, passes_[i].shader, *programs_[i], passes_[i].uniforms))
        warnings.push_back("pass " + passes_[i].shader + ": " + misfit);
    } catch (const std::exception& e) {
      warnings.push_back("pass " + passes_[i].shader + ": " + e.what() +
                         (programs_[i] ? "; the previous shader stays in use" : "; it is left out"));
    }
}

void ScreenPasses::draw(const PictureTarget& picture) {
  const PictureTarget *from = &picture, *to = other_.get();
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glActiveTexture(GL_TEXTURE0);
  const std::array<float, 4> none{};
  for (std::size_t i = 0; i < programs_.size(); ++i) {
    if (!programs_[i]) continue;
    const Program& program = *programs_[i];
    // A pass with the uniform `along` is drawn twice: along x, then along y.
    const bool twice = glGetUniformLocation(program.id(), "along") >= 0;
    for (int axis = 0; axis < (twice ? 2 : 1); ++axis) {
      to->bind();
      glBindTexture(GL_TEXTURE_2D, from->texture());
      program.use();
      program.set("picture", 0);
      program.set("texel", Eigen::Vector2f(1 / static_cast<float>(picture.width()),
                                           1 / static_cast<float>(picture.height())));
      for (const uniform_t& u : passes_[i].uniforms) program.set(u);
      if (twice) program.set("along", axis == 0 ? Eigen::Vector2f(1, 0) : Eigen::Vector2f(0, 1));
      quad_->draw(none.data(), 1);
      std::swap(from, to);
    }
  }
  if (from == &picture) return;
  glDisable(GL_FRAMEBUFFER_SRGB);  // copy the encoded bytes
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from->framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, picture.framebuffer());
  glBlitFramebuffer(0, 0, picture.width(), picture.height(), 0, 0, picture.width(), picture.height(),
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace tactus::visual
