// A question of a study on the bus of a test.
#pragma once

#include <chrono>
#include <mutex>
#include <tactus/question_t.hpp>
#include <thread>

#include "lcmtypes/channels.h"
#include "sync/bus/bus.h"

namespace tactus::cluster {

// Asks a question ten times a second in a thread of its own, also while the test waits for a program: a study whose question is
// 2 s old has ended (sync/node/current_question.h).
class QuestionLeader {
 public:
  explicit QuestionLeader(std::int64_t run_id)
      : bus_(sync::Identity::fresh("leader_test", run_id), {}), thread_([this](const std::stop_token& stop) { repeat(stop); }) {}

  // An id of 0: no question.
  void ask(const question_t& m) {
    const std::lock_guard lock(mutex_);
    question_ = m;
  }

 private:
  void repeat(const std::stop_token& stop) {
    for (; !stop.stop_requested(); std::this_thread::sleep_for(std::chrono::milliseconds(100))) {
      const std::lock_guard lock(mutex_);
      if (question_.id > 0) bus_.publish(channels::kQuestion, question_);
    }
  }
  std::mutex mutex_;
  question_t question_{};
  sync::Bus bus_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace tactus::cluster
