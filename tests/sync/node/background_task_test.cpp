// Tests of factories on a background thread.
#include "sync/node/background_task.h"

#include <catch2/catch.hpp>
#include <future>
#include <stdexcept>

using tactus::sync::BackgroundTask;

namespace {

template <class T>
void wait_for(const BackgroundTask<T>& opening) {
  while (!opening.done()) std::this_thread::yield();
}

}  // namespace

TEST_CASE("A background task returns its result when it is done") {
  BackgroundTask<int> opening([] { return std::make_unique<int>(7); });
  wait_for(opening);
  const auto made = opening.take();
  REQUIRE(made);
  CHECK(*made == 7);
}

TEST_CASE("take() throws the error of a failed background task") {
  BackgroundTask<int> opening([]() -> std::unique_ptr<int> { throw std::runtime_error("no card"); });
  wait_for(opening);
  CHECK_THROWS_WITH(opening.take(), "no card");
}

TEST_CASE("A background task that never ends blocks neither its owner nor the destructor") {
  std::promise<void> never, ended;
  std::shared_future<void> gate = never.get_future();
  {
    BackgroundTask<int> opening([gate, &ended] {
      gate.wait();
      ended.set_value();
      return std::make_unique<int>(1);
    });
    CHECK_FALSE(opening.done());
  }
  never.set_value();
  ended.get_future().wait();
}
