#include "visual_node/gl/labels.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>

namespace tactus::visual {
namespace {

bool is_drawable(const Label& label) {
  const TextPicture* p = label.text.get();
  return p && p->width > 0 && label.first_row >= 0 && label.rows > 0 &&
         label.rows <= p->height - label.first_row &&
         p->coverage.size() == static_cast<std::size_t>(p->width) * static_cast<std::size_t>(p->height);
}

}  // namespace

TextTexture::TextTexture(const TextPicture& picture) {
  glBindTexture(GL_TEXTURE_2D, id_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, picture.width, picture.height, 0, GL_RED, GL_UNSIGNED_BYTE,
               picture.coverage.data());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  for (const auto filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
}

Labels::Stored& Labels::store(const std::shared_ptr<const TextPicture>& picture) {
  const auto known =
      std::find_if(stored_.begin(), stored_.end(), [&](const Stored& s) { return s.picture == picture; });
  if (known != stored_.end()) return *known;
  return stored_.emplace_back(Stored{picture, std::make_unique<TextTexture>(*picture)});
}

void Labels::draw(const std::vector<Label>& labels, int width, int height) {
  for (Stored& s : stored_) s.used = false;
  if (!labels.empty()) {
    glActiveTexture(GL_TEXTURE0);
    program_.use();
    program_.set("size", Eigen::Vector2f(static_cast<float>(width), static_cast<float>(height)));
    program_.set("coverage", 0);
  }
  for (const Label& label : labels) {
    if (!is_drawable(label)) continue;
    Stored& stored = store(label.text);
    stored.used = true;
    glBindTexture(GL_TEXTURE_2D, stored.texture->id());
    const std::array<float, 12> quad{label.x,
                                     label.y,
                                     static_cast<float>(label.text->width),
                                     static_cast<float>(label.rows),
                                     static_cast<float>(label.first_row),
                                     0,
                                     0,
                                     0,
                                     label.red,
                                     label.green,
                                     label.blue,
                                     1};
    quads_.draw(quad.data(), 1);
  }
  std::erase_if(stored_, [](const Stored& s) { return !s.used; });
}

}  // namespace tactus::visual
