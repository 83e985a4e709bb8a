// Tests of the send queue of a page: bounds, order and pictures.
#include "scripts/live/send_queue.h"

#include <catch2/catch.hpp>
#include <random>

using tactus::live::SendQueue;

namespace {

std::shared_ptr<const std::string> text(std::string s) { return std::make_shared<const std::string>(std::move(s)); }

}  // namespace

TEST_CASE("Messages beyond the queue of a page are rejected and counted, and waiting messages are sent in order") {
  SendQueue queue;
  for (std::size_t i = 0; i < SendQueue::kMaxMessages; ++i) REQUIRE(queue.push(text(std::to_string(i))));
  CHECK_FALSE(queue.push(text("late")));
  CHECK(queue.dropped() == 1);
  for (std::size_t i = 0; i < SendQueue::kMaxMessages; ++i) CHECK(*queue.pop()->bytes == std::to_string(i));
  CHECK_FALSE(queue.pop());
  CHECK(queue.bytes() == 0);
  CHECK_FALSE(queue.push(text(std::string(SendQueue::kMaxBytes + 1, 'x'))));
  CHECK(queue.push(text(std::string(SendQueue::kMaxBytes, 'x'))));
  CHECK_FALSE(queue.push(text("x")));
  CHECK(queue.dropped() == 3);
}

TEST_CASE("A slow page receives the newest picture, after its text messages") {
  SendQueue queue;
  for (int i = 0; i < 5; ++i) queue.put_picture(text("picture " + std::to_string(i)));
  queue.push(text("words"));
  CHECK(queue.dropped_pictures() == 4);
  const auto first = queue.pop(), second = queue.pop();
  CHECK((first && !first->binary && *first->bytes == "words"));
  CHECK((second && second->binary && *second->bytes == "picture 4"));
  CHECK_FALSE(queue.pop());
}

TEST_CASE("Under random use a queue stays within its bounds, and every lost message is counted") {
  std::mt19937 random(7);
  SendQueue queue;
  std::int64_t pushed = 0, popped = 0, pictures = 0, shown = 0;
  for (int i = 0; i < 20'000; ++i) {
    switch (random() % 4) {
      case 0: queue.put_picture(text("p")), ++pictures; break;
      case 1:
        if (const auto next = queue.pop()) ++(next->binary ? shown : popped);
        break;
      default: queue.push(text(std::string(random() % 200'000, 't'))), ++pushed;
    }
    REQUIRE(queue.bytes() <= SendQueue::kMaxBytes);
    REQUIRE(queue.waiting() <= SendQueue::kMaxMessages + 1);
  }
  while (const auto next = queue.pop()) ++(next->binary ? shown : popped);
  CHECK(pushed == popped + queue.dropped());
  CHECK(pictures == shown + queue.dropped_pictures());
  CHECK(queue.dropped() > 0);
}
