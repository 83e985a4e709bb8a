#include "visual_node/overlay/question_panel.h"

#include <catch2/catch.hpp>
#include <tactus/question_t.hpp>

#include "lcmtypes/valid.h"
#include "tests/visual_node/support/question_messages.h"
#include "visual_node/frame/text.h"

using namespace tactus;
using namespace tactus::test;
using namespace tactus::visual;

namespace {

struct Picture {
  float width, height;
};
constexpr Picture kPictures[] = {{320, 240}, {640, 480}, {960, 540}, {1280, 720}, {1920, 1080}, {4096, 240}};
constexpr float kMarkers_px = 48;

std::vector<Rect> drawn(const question_t& m, double number, const Picture& p) {
  std::vector<Rect> overlay;
  append_question(overlay, m, number, {0, 0, p.width, p.height - kMarkers_px});
  return overlay;
}
// Height of the smallest part of a letter.
float finest(const std::vector<Rect>& overlay) {
  float least = 1000;
  for (const Rect& r : overlay) least = std::min(least, r.height);
  return least;
}
std::size_t area(const std::vector<Rect>& overlay, float red, float green, float blue) {
  double sum = 0;
  for (const Rect& r : overlay)
    if (r.red == red && r.green == green && r.blue == blue) sum += r.width * r.height;
  return static_cast<std::size_t>(sum);
}
std::size_t pixels(std::string_view text, float size) {
  std::vector<Rect> letters;
  append_letters(letters, text, 0, 0, size);
  return area(letters, 1, 1, 1);
}

// As long as the message allows.
question_t longest() {
  question_t m = choice(1, std::vector<std::string>(9, std::string(40, 'W')));
  m.text.clear();
  while (m.text.size() + 8 <= 600) m.text += "wherever ";
  m.text.resize(600, 'x');
  m.progress = std::string(64, 'p');
  m.header.run_id = 1;
  REQUIRE(valid(m));
  return m;
}

}  // namespace

TEST_CASE("Text wraps at a blank, and a long word is split at the line end") {
  using Lines = std::vector<std::string>;
  CHECK(wrap_text("", 10).empty());
  CHECK(wrap_text("ten letter", 10) == Lines{"ten letter"});
  CHECK(wrap_text("ten letters", 10) == Lines{"ten", "letters"});
  CHECK(wrap_text("ten  letters go", 11) == Lines{"ten ", "letters go"});
  CHECK(wrap_text("unbelievable", 5) == Lines{"unbel", "ievab", "le"});
  CHECK(wrap_text("ab cd", 2) == Lines{"ab", "cd"});
  for (const std::string& line : wrap_text(longest().text, 17)) CHECK(line.size() <= 17);
}

TEST_CASE("A number has as many decimals as its step") {
  CHECK(number_text(3, 1) == "3");
  CHECK(number_text(0.25, 0.25) == "0.25");
  CHECK(number_text(-1.5, 0.1) == "-1.5");
  CHECK(number_text(20, 10) == "20");
  CHECK(number_text(-0.0, 0.5) == "0.0");
  CHECK(number_text(1.0 / 3, 1.0 / 3) == "0.333333");
}

TEST_CASE(
    "A question of usual length is drawn completely in the lower two thirds in large letters") {
  question_t yes_no = choice(1, {"yes", "no"}), stiff = number(2, 0, 100, 1), read = question(3, question_t::READ);
  stiff.count = 2, stiff.choices = {"very soft", "very hard"};
  for (question_t* m : {&yes_no, &stiff, &read}) {
    m->progress = "block 1 of 4";
    for (const Picture& p : kPictures) {
      CAPTURE(static_cast<int>(m->kind), p.width, p.height);
      const auto rects = drawn(*m, 50, p);
      REQUIRE(rects.size() > 100);
      const Rect& plate = rects.front();
      CHECK(plate.alpha < 1);
      CHECK(plate.y >= (p.height - kMarkers_px) / 3 - 1);
      // No pixel leaves the plate or covers the markers.
      for (const Rect& r : rects) {
        CHECK(r.x >= plate.x);
        CHECK(r.y >= plate.y);
        CHECK(r.x + r.width <= plate.x + plate.width + 0.01f);
        CHECK(r.y + r.height <= plate.y + plate.height + 0.01f);
        CHECK(r.y + r.height <= p.height - kMarkers_px);
      }
      const float size = std::max(1.0f, std::round((p.height - kMarkers_px) / 180));
      std::size_t wanted = pixels(m->text, size);
      if (m->kind == question_t::CHOICE) wanted += pixels("yes", size) + pixels("no", size);
      if (m->kind == question_t::NUMBER) wanted += pixels("very soft", size) + pixels("very hard", size);
      CHECK(area(rects, 1, 1, 1) == wanted);
    }
  }
}

TEST_CASE("The hint of the study replaces the English names of the keys") {
  question_t m = question(1, question_t::READ);
  const auto english = drawn(m, 0, {640, 480});
  m.hint = "Enter: continue";
  const auto same = drawn(m, 0, {640, 480});
  CHECK(same.size() == english.size());
  m.hint = "Eingabe: weiter";
  CHECK(is_ascii(m));
  CHECK(drawn(m, 0, {640, 480}).size() != english.size());
  m.hint = "\xd0\x92\xd0\xb2\xd0\xbe\xd0\xb4";
  CHECK_FALSE(is_ascii(m));
}

TEST_CASE("The longest possible question is drawn completely within the picture") {
  const question_t m = longest();
  for (const Picture& p : kPictures) {
    CAPTURE(p.width, p.height);
    const auto rects = drawn(m, 0, p);
    for (const Rect& r : rects) {
      CHECK((r.x >= 0 && r.y >= 0 && r.x + r.width <= p.width));
      CHECK(r.y + r.height <= p.height - kMarkers_px + 0.01f);
    }
    std::size_t wanted = 0;
    const float size = finest(rects);
    for (const std::string& c : m.choices) wanted += pixels(c, size);
    CHECK(area(rects, 1, 1, 1) >= wanted);  // choices are never left out
    if (p.height >= 480) {
      for (const char c : m.text) wanted += pixels(std::string(1, c), size);
      CHECK(area(rects, 1, 1, 1) >= wanted);
    }
  }
}

TEST_CASE("A question of usual length is drawn in letters of the chosen size, and takes more of the picture for them") {
  question_t m = choice(1, {"yes", "no"});
  m.text = "Did the ball feel soft?";
  for (const float factor : {0.5f, 1.0f, 2.0f})
    for (const char* contrast : {"dark", "light", "high"}) {
      const TextLook look = text_look(contrast, factor);
      std::vector<Rect> overlay;
      append_question(overlay, m, 0, {0, 0, 1280, 720}, look);
      CAPTURE(factor, contrast);
      REQUIRE(overlay.size() > 100);
      // 720 lines: 4 pixels a letter's pixel. Those of the question itself, not of the smaller hint.
      float size = 0;
      for (const Rect& r : overlay)
        if (Eigen::Vector3f(r.red, r.green, r.blue) == look.words) size = std::max(size, r.height);
      CHECK(size == 4 * factor);
      const Rect& plate = overlay.front();
      CHECK((Eigen::Vector3f(plate.red, plate.green, plate.blue) == look.question.colour && plate.alpha == look.question.opacity));
      CHECK(plate.y + plate.height <= 720);
    }
}

TEST_CASE("Letters of any chosen size get smaller until the longest question is within the picture") {
  const question_t m = longest();
  for (const float factor : {0.5f, 1.3f, 2.0f, 4.0f})
    for (const Picture& p : kPictures) {
      CAPTURE(factor, p.width, p.height);
      std::vector<Rect> rects;
      const TextLook look = text_look("dark", factor);
      append_question(rects, m, 0, {0, 0, p.width, p.height - kMarkers_px}, look);
      for (const Rect& r : rects) {
        CHECK((r.x >= 0 && r.y >= 0 && r.x + r.width <= p.width));
        CHECK(r.y + r.height <= p.height - kMarkers_px + 0.01f);
      }
      std::size_t wanted = 0;
      for (const std::string& c : m.choices) wanted += pixels(c, finest(rects));
      CHECK(area(rects, 1, 1, 1) >= wanted);  // choices are never left out
    }
}

TEST_CASE("The mark of a number is at its position on the slider and never beyond it") {
  const question_t m = number(1, -1, 1, 0.1);
  const auto mark_x = [&](double at) {
    const auto rects = drawn(m, at, {640, 480});
    const Rect* mark = nullptr;  // the highest rectangle of its colour
    for (const Rect& r : rects)
      if (r.green == 0.78f && (!mark || r.height > mark->height)) mark = &r;
    REQUIRE(mark);
    return mark->x + mark->width / 2;
  };
  CHECK(mark_x(0) == Approx(320).margin(0.51));
  CHECK(mark_x(-1) + mark_x(1) == Approx(640).margin(1.01));
  CHECK(mark_x(0.5) == Approx((mark_x(0) + mark_x(1)) / 2));
  CHECK(mark_x(-1) > 32);
}
