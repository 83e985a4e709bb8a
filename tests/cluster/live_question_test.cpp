// Tests of a study's questions in the live page: the test publishes them on the bus, scripts/live/page/test answers in a real browser, and
// the test receives the answers.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <tactus/answer_t.hpp>
#include <tactus/question_t.hpp>
#include <thread>

#include "lcmtypes/channels.h"
#include "sync/bus/bus.h"
#include "tests/cluster/support/processes.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

constexpr double kAnswerTimeout_s = 60;  // liveness, not speed
constexpr std::int64_t kRunId = 4712;
constexpr const char* kToken = "0123456789abcdef0123";
constexpr std::int64_t kFirst = 4'611'686'018'427'387'901;  // no double represents it: JavaScript must not use one either

question_t question(std::int64_t id, int kind, const std::string& text, std::vector<std::string> choices = {}) {
  question_t m{};
  m.header.sim_time_ns = -1;
  m.id = id;
  m.kind = static_cast<std::int8_t>(kind);
  m.text = text;
  m.count = static_cast<std::int32_t>(choices.size());
  m.choices = std::move(choices);
  m.progress = "block 1 of 4";
  m.trial = static_cast<std::int32_t>(id - kFirst + 1);
  m.condition = "audio +80 ms";
  return m;
}

// In this order, each until it is answered and for a second more. study.test.mjs identifies them by their text.
std::vector<question_t> study() {
  std::vector<question_t> all{
      question(kFirst, question_t::READ, "You will see a ball fall and hear it."),
      question(kFirst + 1, question_t::CHOICE, "Was it at the same time?", {"at the same time", "not at the same time"}),
      question(kFirst + 2, question_t::CHOICE, "Which was first?", {"sound", "flash", "neither"}),
      question(kFirst + 3, question_t::NUMBER, "How hard was it?", {"very soft", "very hard"}),
      question(kFirst + 4, question_t::NUMBER, "How warm was it?")};
  all[3].lowest = 0, all[3].highest = 100, all[3].step = 1;
  all[4].lowest = -1, all[4].highest = 1, all[4].step = 0.05;
  return all;
}

}  // namespace

TEST_CASE(
    "The live page answers questions of a study by click, key and slider, and rejects malformed answers "
    "and those of observer pages",
    "[browser]") {
  INFO("install the packages chromium, nodejs and npm, and run scripts/live/bundle --for-tests");
  const std::filesystem::path page = repository() / "scripts/live/page";
  REQUIRE(std::filesystem::exists("/usr/bin/chromium"));
  REQUIRE(std::filesystem::exists(page / "node_modules/puppeteer-core/package.json"));
  REQUIRE(std::filesystem::exists(page / "dist/main.js"));
  Folder folder;
  Processes processes(folder.path(), kRunId);
  constexpr const char* kPort = "8093";
  processes.spawn("live_server", {programs() / "live_server", "--run-id", std::to_string(kRunId), "--page", page / "dist", "--token",
                                  kToken, "--http-port", kPort});
  std::vector<std::string> command{"node", page / "test/study.test.mjs",
                                   std::string("http://127.0.0.1:") + kPort + "/?token=" + kToken};
  if (const char* keep = std::getenv("TACTUS_SCREENSHOTS")) command.emplace_back(keep);
  processes.spawn("browser", command);

  sync::Bus bus(sync::Identity::fresh("conductor", kRunId), {});
  auto& answer_queue = bus.queue<answer_t>(channels::kAnswer, 1024);
  std::map<std::int64_t, std::vector<answer_t>> answers;
  std::vector<question_t> remaining = study();
  sync::HostTime next_question_time{};  // time at which the current question was answered
  const sync::HostTime end = sync::host_now() + sync::from_seconds(2 * kAnswerTimeout_s);
  for (sync::HostTime next{}; processes.running("browser") && sync::host_now() < end; bus.wait(std::chrono::milliseconds(20))) {
    const sync::HostTime now = sync::host_now();
    bus.drain(now);
    while (const auto m = answer_queue.pop()) answers[m->message.id].push_back(m->message);
    if (!remaining.empty() && answers.contains(remaining.front().id)) {
      if (next_question_time == sync::HostTime{}) next_question_time = now + sync::from_seconds(1);
      if (now >= next_question_time) remaining.erase(remaining.begin()), next_question_time = {};
    }
    if (now < next) continue;
    next = now + std::chrono::milliseconds(200);
    question_t m = remaining.empty() ? question(kFirst + 5, question_t::NOTHING, "") : remaining.front();
    bus.publish(channels::kQuestion, m);
  }
  const int status = processes.wait_for_exit("browser", kAnswerTimeout_s);
  INFO(processes.output("browser"));
  INFO(processes.output("live_server"));
  CHECK(status == 0);
  CHECK(remaining.empty());
  const std::vector<question_t> questions = study();
  CHECK(answers.size() == questions.size());  // no other question has an answer
  for (const question_t& m : questions) {
    CAPTURE(m.text);
    REQUIRE(answers.contains(m.id));
    CHECK(answers[m.id].size() >= 3);  // the answer is repeated for each repetition of the question
    for (const answer_t& a : answers[m.id]) {
      CHECK((a.choice == answers[m.id][0].choice && a.number == answers[m.id][0].number));
      CHECK(a.by == "page");
      CHECK((a.after_ns > 0 && a.after_ns < static_cast<std::int64_t>(kAnswerTimeout_s * 1e9)));
    }
  }
  CHECK(answers[kFirst][0].choice == -1);
  CHECK(answers[kFirst + 1][0].choice == 1);
  CHECK(answers[kFirst + 2][0].choice == 2);
  CHECK(answers[kFirst + 3][0].number == 64);
  CHECK(answers[kFirst + 4][0].number == Approx(0.15));
}
