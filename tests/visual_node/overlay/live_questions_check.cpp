// Questions beyond ASCII from the bus to the picture, with the program draw_text.
#include "visual_node/overlay/live_questions.h"

#include <catch2/catch.hpp>
#include <tactus/answer_t.hpp>

#include "sync/bus/bus.h"
#include "tests/times.h"
#include "tests/visual_node/support/question_messages.h"

using namespace tactus;
using namespace tactus::visual;
using tactus::test::at_ms;

namespace {

constexpr int kEnterKey = 257;  // of GLFW

struct QuestionWindow {
  sync::Bus bus{sync::Identity::fresh("visual_node", 7), [] {
                  sync::BusOptions options;
                  options.memory = true;
                  return options;
                }()};
  sync::Queue<answer_t>& answers{bus.queue<answer_t>(channels::kAnswer, 8)};
  LiveQuestions questions{bus, true};

  // Asks the text and draws it into a picture, which is presented; then presses Enter.
  Frame ask(std::int64_t id, const std::string& text) {
    question_t m = test::question(id, question_t::READ);
    m.text = text;
    bus.publish(channels::kQuestion, m);
    bus.drain(at_ms(1000));
    questions.step();
    Frame frame;
    questions.append(frame, at_ms(1001), 640, 480);
    questions.presented(at_ms(1010));
    questions.press(kEnterKey, at_ms(1500));
    bus.drain(at_ms(1501));
    return frame;
  }
};

}  // namespace

TEST_CASE("A question in another language is drawn from the bus, and answered") {
  QuestionWindow window;
  const Frame frame = window.ask(1, "\u0928\u092e\u0938\u094d\u0924\u0947");
  CHECK(frame.list.labels.size() == 2);  // the text and the hint
  CHECK_FALSE(window.questions.take_problem());
  const auto answer = window.answers.pop();
  REQUIRE(answer);
  CHECK((answer->message.id == 1 && answer->message.after_ns == 490'000'000));
}

TEST_CASE("A question with a character that no font covers shows a sentence instead, and cannot be answered") {
  QuestionWindow window;
  const Frame frame = window.ask(1, "a\U0010fffd");
  CHECK(frame.list.labels.empty());
  CHECK(frame.list.overlay.size() > 100);  // the letters of the sentence
  const auto problem = window.questions.take_problem();
  REQUIRE(problem);
  CHECK_THAT(*problem, Catch::Contains("no installed font covers U+10FFFD") && Catch::Contains("scripts/setup fonts"));
  window.ask(1, "a\U0010fffd");
  CHECK_FALSE(window.questions.take_problem());  // once
  CHECK_FALSE(window.answers.pop());
  // The next question is drawn again.
  CHECK(window.ask(2, "\u0434\u0430").list.labels.size() == 2);
  CHECK(window.answers.pop());
}
