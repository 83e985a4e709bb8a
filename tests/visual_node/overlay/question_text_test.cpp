// Tests of questions in characters beyond ASCII, with a substitute for the program that draws text.
#include "visual_node/overlay/question_text.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "tests/visual_node/support/question_messages.h"
#include "visual_node/overlay/question_panel.h"

using namespace tactus;
using namespace tactus::test;
using namespace tactus::visual;

namespace {

const std::string kYes = "\xd0\xb4\xd0\xb0", kAsk = "\xd0\x92\xd0\xbc\xd0\xb5\xd1\x81\xd1\x82\xd0\xb5?";

// Every byte is half an em wide and a line 5/4 em high; Arabic and Hebrew lead bytes are written from right to
// left.
DrawnText substitute(const TextRequest& request) {
  DrawnText text;
  int rows = 0, width = 0;
  for (const TextBlock& b : request.blocks) {
    const int across = std::max(1, 2 * b.width_px / b.size_px), line = 5 * b.size_px / 4;
    const int lines = (static_cast<int>(b.text.size()) + across - 1) / across;
    const bool mirrored = !b.text.empty() && (static_cast<unsigned char>(b.text[0]) & 0xfc) == 0xd4;
    text.blocks.push_back({request.measure ? 0 : rows, lines * line, lines ? line : 0, mirrored});
    rows += lines * line, width = std::max(width, b.width_px);
  }
  if (!request.measure)
    text.picture = {width, rows, std::vector<std::uint8_t>(static_cast<std::size_t>(width * rows), 255)};
  return text;
}

question_t asked(int kind = question_t::CHOICE) {
  question_t m = kind == question_t::NUMBER   ? number(2, 0, 100, 1)
                 : kind == question_t::CHOICE ? choice(1, {kYes, "no"})
                                              : question(3, kind);
  m.text = kAsk, m.progress = "1/4";
  if (kind == question_t::NUMBER) m.count = 2, m.choices = {kYes, "no"};
  return m;
}

}  // namespace

TEST_CASE("A question with any character beyond ASCII is typeset") {
  CHECK(is_ascii(choice(1, {"yes", "no"})));
  CHECK_FALSE(is_ascii(choice(1, {"yes", kYes})));
  question_t m = question(2, question_t::READ);
  m.progress = kYes;
  CHECK_FALSE(is_ascii(m));
}

TEST_CASE("Typeset texts lie on the plate, in their order, with the largest letters that fit") {
  for (const int kind : {question_t::READ, question_t::CHOICE, question_t::NUMBER})
    for (const TextArea& room :
         {TextArea{0, 0, 640, 432}, TextArea{0, 0, 1920, 1032}, TextArea{320, 0, 640, 192}}) {
      const question_t m = asked(kind);
      const QuestionText text = typeset_question(m, room, substitute);
      REQUIRE(text.problem.empty());
      std::vector<Rect> overlay;
      std::vector<Label> labels;
      append_question(overlay, labels, m, 50, room, text);
      CHECK(labels.size() == text.blocks.size());
      CHECK(text.size.size == std::max(1.0f, std::round((room.bottom - room.y) / 180)));
      const Rect& plate = overlay.front();
      float last = plate.y;
      for (std::size_t i = 0; i < labels.size(); ++i) {
        const Label& l = labels[i];
        CHECK(
            (l.text == text.picture && l.first_row == text.blocks[i].first_row && l.rows == text.blocks[i].rows));
        CHECK((l.x == std::floor(l.x) && l.y == std::floor(l.y)));
        CHECK(
            (l.x >= plate.x && l.y >= plate.y && l.y + static_cast<float>(l.rows) <= plate.y + plate.height + 1));
        const bool beside = kind == question_t::NUMBER && i == 2;  // the other end of the scale
        CHECK(l.y >= last - static_cast<float>(beside ? text.blocks[1].rows : 0) - 1);
        last = l.y + static_cast<float>(l.rows);
      }
      CHECK(plate.y + plate.height <= room.bottom);
    }
}

TEST_CASE("A typeset question is never larger than its room, and its choices are never left out") {
  question_t m = asked();
  for (int i = 0; i < 120; ++i) m.text += kAsk;
  m.choices.assign(9, kYes), m.count = 9;
  for (const TextArea& room : {TextArea{0, 0, 640, 432}, TextArea{0, 0, 320, 192}, TextArea{0, 0, 160, 90}}) {
    const QuestionText text = typeset_question(m, room, substitute);
    REQUIRE(text.problem.empty());
    std::vector<Rect> overlay;
    std::vector<Label> labels;
    append_question(overlay, labels, m, 0, room, text);
    REQUIRE(labels.size() == 11 + 1);
    for (std::size_t i = 1; i < 10; ++i) CHECK(labels[i].rows == text.blocks[i].rows);
    CHECK(labels[0].rows > 0);
    if (room.bottom > 100) CHECK(overlay.front().y + overlay.front().height <= room.bottom + 1);
  }
}

TEST_CASE("The keys of a question that is written from right to left are at the right") {
  question_t m = asked();
  m.text = "\xd7\x94\xd7\x90\xd7\x9d", m.choices = {"\xd7\x9b\xd7\x9f", "\xd7\x9c\xd7\x90"};
  const TextArea room{0, 0, 640, 432};
  const auto key_x = [&](const question_t& q) {
    std::vector<Rect> overlay;
    std::vector<Label> labels;
    append_question(overlay, labels, q, 0, room, typeset_question(q, room, substitute));
    return overlay[1].x;  // after the plate
  };
  CHECK(key_x(m) > 500);
  CHECK(key_x(asked()) < 100);
}

TEST_CASE("A question that cannot be drawn has a sentence in place of its texts") {
  const QuestionText uncovered = typeset_question(asked(), {0, 0, 640, 432}, [](const TextRequest&) {
    DrawnText text;
    text.missing = {U'\u0905'};
    return text;
  });
  CHECK(uncovered.problem ==
        "no installed font covers U+0905 of the question; install a font that does, for example with "
        "scripts/setup fonts");
  const QuestionText failed = typeset_question(asked(), {0, 0, 640, 432}, [](const TextRequest&) -> DrawnText {
    throw std::runtime_error("the program draw_text is missing; build it");
  });
  CHECK(failed.problem == "the question cannot be drawn: the program draw_text is missing; build it");
}

TEST_CASE("Texts are typeset once for each question and size of room, and a loop never waits for them") {
  struct Gate {
    std::mutex mutex;
    std::condition_variable changed;
    bool open = false;
    int drawn = 0;
  };
  const auto gate = std::make_shared<Gate>();
  QuestionTexts texts(false, [gate] {
    return [gate](const TextRequest& request) {
      std::unique_lock lock(gate->mutex);
      gate->changed.wait(lock, [&] { return gate->open; });
      gate->drawn += !request.measure;
      return substitute(request);
    };
  });
  const question_t m = asked();
  const TextArea room{0, 0, 640, 432}, half{0, 0, 320, 432};
  for (int i = 0; i < 100; ++i) CHECK_FALSE(texts.find(m, room));
  {
    const std::lock_guard lock(gate->mutex);
    gate->open = true;
  }
  gate->changed.notify_all();
  const auto wait = [&](const question_t& q, const TextArea& r) {
    const QuestionText* text = nullptr;
    while (!(text = texts.find(q, r))) std::this_thread::yield();
    return text->picture;
  };
  const auto first = wait(m, room);
  wait(m, half);
  for (int i = 0; i < 100; ++i) CHECK(texts.find(m, room)->picture == first);
  question_t next = m;
  next.id = 9;
  CHECK(wait(next, room) != first);
  const std::lock_guard lock(gate->mutex);
  CHECK(gate->drawn == 3);
}

TEST_CASE("A question is typeset again for each chosen size of letters, however often it changes") {
  QuestionTexts texts(true, [] { return substitute; });
  const TextArea room{0, 0, 1280, 720};
  for (int i = 0; i < 20; ++i)
    for (const float factor : {1.0f, 2.0f, 0.5f}) {
      const QuestionText* text = texts.find(asked(question_t::READ), room, factor);
      REQUIRE(text);
      CHECK(text->size.size == 4 * factor);
    }
}

TEST_CASE("A log shows a typeset question in its first picture") {
  QuestionTexts texts(true, [] { return substitute; });
  CHECK(texts.find(asked(), {0, 0, 640, 432}));
}
