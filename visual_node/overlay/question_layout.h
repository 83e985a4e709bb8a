// The places of the parts of a question on its plate, for texts of rectangles and for typeset texts. Pure.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <tactus/question_t.hpp>
#include <vector>

#include "visual_node/overlay/panel.h"
#include "visual_node/scene_view/draw_list.h"
#include "visual_node/text/text_blocks.h"

namespace tactus::visual {

// A text of the question, broken into lines of this width. size: pixels of a letter's pixel (frame/text.h).
struct QuestionBlock {
  std::string text;
  float width = 0, size = 1;
  TextEdge edge = TextEdge::kNatural;  // the ends of a scale: left and right
};

class QuestionLayout {
 public:
  // Draws block number `block` with its upper left corner there.
  using DrawBlock = std::function<void(std::size_t block, float x, float y, const Eigen::Vector3f& colour)>;

  // width: of the plate; size: of its letters; leading: between two lines, in pixels of a letter.
  QuestionLayout(const question_t& m, float width, float size, float leading);

  // The question, its choices or the two ends of its scale, the hint and the progress.
  const std::vector<QuestionBlock>& blocks() const { return blocks_; }
  // Height of the plate, when the blocks have these heights. All lengths in pixels.
  float height(const std::vector<float>& blocks) const;
  // mirrored: the keys of the choices are at the right, for writing from right to left.
  void draw(std::vector<Rect>& overlay, double number, float x, float y, const std::vector<float>& blocks,
            bool mirrored, const TextLook& look, const DrawBlock& draw_block) const;

 private:
  float line(float size) const;
  float gap() const { return leading_ * size_; }
  float slider(std::vector<Rect>& overlay, double number, float left, float y, const std::vector<float>& blocks,
               const TextLook& look, const DrawBlock& draw_block) const;

  const question_t& m_;
  float width_, size_, small_, leading_, inner_;
  std::vector<QuestionBlock> blocks_;
  std::size_t choices_ = 0, ends_ = 0;  // number of blocks after the question
};

// A size of letters to try, with the height of the plate that it may have: large letters in two thirds of the room
// first. The last try must be used, even if its plate is higher. factor: TextLook::size; above 1, letters take the whole room before
// they get smaller.
struct LetterSize {
  float size, leading, height, margin;
};
std::vector<LetterSize> letter_sizes(const TextArea& room, float factor = 1);
// Width of the plate in the room.
float plate_width(const TextArea& room);
// Upper left corner of a plate of that height.
Eigen::Vector2f plate_corner(const TextArea& room, float height, float margin);

// A number with as many decimals as the step of the question has, at most six.
std::string number_text(double number, double step);

}  // namespace tactus::visual
