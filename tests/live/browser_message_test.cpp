// Tests of parsing messages of the browser.
#include "scripts/live/browser_message.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>
#include <tactus/sim_command_t.hpp>

using namespace tactus;
using namespace tactus::live;

namespace {

const std::vector<std::string> kGood{
    R"({"t":"watch","names":["TOOL_STATE:force_N.z","sim_node.work.collision"]})",
    R"({"t":"command","what":"pause"})",
    R"({"t":"command","what":"step","steps":25})",
    R"({"t":"degrade","clear":false,"senses":{"audio":{"delay_ms":80,"rate_Hz":0,"loss":0.25}}})",
    R"({"t":"hand","x":-0.5,"y":1,"push_m":0,"down":true})",
    R"({"t":"play","play":true,"rate":2})",
    R"({"t":"seek","to_s":12.5})",
    R"({"t":"answer","question":"4.11","choice":1,"number":0,"after_ns":350000000})",
};

// Checks the bounds of a message, for any input.
void check_bounds(const BrowserMessage& m) {
  if (const auto* w = std::get_if<WatchRequest>(&m)) {
    CHECK(w->names.size() <= kMaxWatched);
    for (const std::string& n : w->names) CHECK((!n.empty() && n.size() <= 192));
  } else if (const auto* c = std::get_if<Command>(&m)) {
    CHECK((c->kind >= sim_command_t::PAUSE && c->kind <= sim_command_t::RESET));
    CHECK((c->steps >= 0 && c->steps <= 10'000));
  } else if (const auto* d = std::get_if<DegradeRequest>(&m)) {
    CHECK(d->senses.size() <= 16);
    for (const auto& [name, s] : d->senses) {
      CHECK((s.delay_ms >= 0 && s.delay_ms <= 1e9));
      CHECK((s.rate_Hz >= 0 && s.rate_Hz <= 1e9));
      CHECK((s.loss >= 0 && s.loss <= 1));
    }
  } else if (const auto* h = std::get_if<HandTarget>(&m)) {
    CHECK((std::abs(h->x) <= 1 && std::abs(h->y) <= 1 && std::abs(h->push_m) <= 1));
  } else if (const auto* p = std::get_if<LogPlay>(&m)) {
    CHECK((p->rate >= 0.1 && p->rate <= 16));
  } else if (const auto* a = std::get_if<PageAnswer>(&m)) {
    CHECK((!a->question.empty() && a->question.size() <= 64));
    CHECK((a->choice >= -1 && a->choice <= 8 && std::abs(a->number) <= 1e9 && a->after_ns >= 0));
  } else {
    CHECK((std::get<LogSeek>(m).to_s >= 0 && std::get<LogSeek>(m).to_s <= 1e7));
  }
}

// True when the message is accepted. Any exception without one sentence fails the test.
bool accepted(const std::string& text) {
  try {
    check_bounds(parse_browser_message(text));
    return true;
  } catch (const std::invalid_argument& e) {
    const std::string why = e.what();
    CHECK(why.size() > 20);
    CHECK(why.find(';') != std::string::npos);  // the problem; the remedy
    CHECK(why.find('\n') == std::string::npos);
    return false;
  }
}

}  // namespace

TEST_CASE("Each kind of page message is parsed") {
  const auto watch = std::get<WatchRequest>(parse_browser_message(kGood[0]));
  CHECK(watch.names == std::vector<std::string>{"TOOL_STATE:force_N.z", "sim_node.work.collision"});
  CHECK(std::get<Command>(parse_browser_message(kGood[1])).kind == sim_command_t::PAUSE);
  const auto step = std::get<Command>(parse_browser_message(kGood[2]));
  CHECK((step.kind == sim_command_t::STEP && step.steps == 25));
  CHECK(std::get<Command>(parse_browser_message(R"({"t":"command","what":"resume"})")).kind == sim_command_t::RESUME);
  CHECK(std::get<Command>(parse_browser_message(R"({"t":"command","what":"reset"})")).kind == sim_command_t::RESET);
  const auto worse = std::get<DegradeRequest>(parse_browser_message(kGood[3]));
  REQUIRE(worse.senses.contains("audio"));
  CHECK(worse.senses.at("audio").delay_ms == 80);
  CHECK(worse.senses.at("audio").loss == 0.25);
  CHECK_FALSE(worse.clear);
  const auto hand = std::get<HandTarget>(parse_browser_message(kGood[4]));
  CHECK((hand.x == -0.5 && hand.y == 1 && hand.push_m == 0 && hand.down));
  const auto play = std::get<LogPlay>(parse_browser_message(kGood[5]));
  CHECK((play.play && play.rate == 2));
  CHECK(std::get<LogSeek>(parse_browser_message(kGood[6])).to_s == 12.5);
  const auto answer = std::get<PageAnswer>(parse_browser_message(kGood[7]));
  CHECK((answer.question == "4.11" && answer.choice == 1 && answer.number == 0 && answer.after_ns == 350'000'000));
}

TEST_CASE("Malformed and out-of-range page messages are rejected with a sentence") {
  for (const char* text :
       {"", "null", "[]", "{}", "{\"t\":1}", R"({"t":"fly"})", R"({"t":"command"})", R"({"t":"command","what":"push"})",
        R"({"t":"command","what":"set"})", R"({"t":"command","what":"step"})", R"({"t":"command","what":"step","steps":0})",
        R"({"t":"command","what":"step","steps":10001})", R"({"t":"command","what":"step","steps":1e300})",
        R"({"t":"hand","x":1.01,"y":0,"push_m":0,"down":true})", R"({"t":"hand","x":0,"y":0,"push_m":0,"down":1})",
        R"({"t":"hand","x":"0","y":0,"push_m":0,"down":true})", R"({"t":"play","play":true,"rate":0})",
        R"({"t":"seek","to_s":-1})", R"({"t":"seek","to_s":1e400})", R"({"t":"watch","names":"x"})",
        R"({"t":"watch","names":[1]})", R"({"t":"watch","names":["a b"]})", R"({"t":"watch","names":["a\n"]})",
        R"({"t":"degrade","clear":false,"senses":[]})", R"({"t":"degrade","senses":{}})",
        R"({"t":"degrade","clear":false,"senses":{"a\"/>":{"delay_ms":1,"rate_Hz":0,"loss":0}}})",
        R"({"t":"degrade","clear":false,"senses":{"audio":{"delay_ms":1,"rate_Hz":-1,"loss":0}}})",
        R"({"t":"degrade","clear":false,"senses":{"audio":{"delay_ms":1,"rate_Hz":0,"loss":0,"deadband":"1"}}})",
        R"({"t":"degrade","clear":false,"senses":{"audio":{"delay_ms":1,"rate_Hz":0,"loss":0,"choices":["tdpa"]}}})",
        R"({"t":"degrade","clear":false,"senses":{"audio":{"delay_ms":1,"rate_Hz":0,"loss":0,"choices":{"passivity":"\"/>"}}}})",
        R"({"t":"degrade","clear":false,"senses":{"audio":{"delay_ms":1,"rate_Hz":0,"loss":0,"choices":{"a=\"b\"":"tdpa"}}}})",
        R"({"t":"degrade","clear":false,"senses":{"audio":{"delay_ms":1e10,"rate_Hz":0,"loss":0}}})",
        R"({"t":"degrade","clear":false,"senses":{"audio":{"delay_ms":1,"rate_Hz":0}}})",
        R"({"t":"answer","choice":1,"number":0,"after_ns":0})", R"({"t":"answer","question":11,"choice":1,"number":0,"after_ns":0})",
        R"({"t":"answer","question":"4.11","choice":0.5,"number":0,"after_ns":0})",
        R"({"t":"answer","question":"4.11","choice":9,"number":0,"after_ns":0})",
        R"({"t":"answer","question":"4.11","choice":-1,"number":null,"after_ns":0})",
        R"({"t":"answer","question":"4.11","choice":-1,"number":1e10,"after_ns":0})",
        R"({"t":"answer","question":"4.11","choice":1,"number":0,"after_ns":-1})"}) {
    INFO(text);
    CHECK_FALSE(accepted(text));
  }
  nlohmann::json many{{"t", "watch"}, {"names", nlohmann::json::array()}};
  for (std::size_t i = 0; i <= kMaxWatched; ++i) many["names"].push_back("n" + std::to_string(i));
  CHECK_FALSE(accepted(many.dump()));
  CHECK_FALSE(accepted(std::string(kMaxBrowserBytes + 1, ' ')));
  CHECK_FALSE(accepted(std::string(kMaxBrowserBytes, '[')));  // deep nesting
}

TEST_CASE("10,000 mutated messages are parsed within their bounds or rejected with a sentence") {
  std::mt19937 random(20);
  const std::string letters = "{}[]\":,.-+eE0123456789truefalsnu\\ \x01\x7f\xc3\xff";
  int good = 0, refused = 0;
  for (int i = 0; i < 10'000; ++i) {
    std::string text = kGood[random() % kGood.size()];
    for (auto changes = 1 + random() % 3; changes-- > 0;) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0: text[at] = letters[random() % letters.size()]; break;
        case 1: text.insert(at, 1, letters[random() % letters.size()]); break;
        case 2: text.erase(at, 1 + random() % 3); break;
        default: text.insert(at, text.substr(random() % text.size(), random() % 12));
      }
      if (text.empty()) text = "x";
    }
    ++(accepted(text) ? good : refused);
  }
  CHECK(good > 100);  // both occur; otherwise the mutations test nothing
  CHECK(refused > 1000);
}
