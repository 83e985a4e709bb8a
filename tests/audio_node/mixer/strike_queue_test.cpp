// The modes of strikes are kept while the callback may read them, also when the scene changes, and are then freed.
#include "audio_node/mixer/strike_queue.h"

#include <catch2/catch.hpp>
#include <random>

#include "tests/audio_node/support/bench.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

// Its deleter makes the values audible, so that a read after the release fails the test.
StrikeQueue::Table table(double frequency_Hz) {
  auto* const all = new ResonatorTable(1);
  all->front().add(mode_step(frequency_Hz, 20, kRate));
  return {all, [](const ResonatorTable* gone) {
            auto* const old = const_cast<ResonatorTable*>(gone);
            old->front().stiffness.fill(1e6f);
            delete old;
          }};
}

// A loop and a callback in one thread, in alternation.
struct StrikeFixture {
  std::unique_ptr<Bench> bench = std::make_unique<Bench>();
  StrikeQueue queue{bench->queues};

  bool strike(const StrikeQueue::Table& of, int later_samples, std::int64_t id = 1) {
    Strike s = strike_of(id, id, 500, 20, bench->time_ns(bench->left.size() + static_cast<std::size_t>(later_samples)));
    if (of) s.sides[0].resonators = &of->front();
    return queue.submit(s, of);
  }
  void play(int frames) {
    bench->play(frames);
    queue.free_released();
  }
};

}  // namespace

TEST_CASE("A table is kept while a strike of it waits, and is freed once only later scenes have strikes") {
  StrikeFixture l;
  auto first = table(500), second = table(700);
  const std::weak_ptr<const ResonatorTable> old = first;
  REQUIRE(l.strike(first, 4800));
  first.reset();
  l.play(128);
  CHECK_FALSE(old.expired());
  REQUIRE(l.strike(second, 9600, 2));
  CHECK(l.queue.kept() == 1);
  for (int i = 0; i < 20; ++i) {
    l.play(128);
    CHECK_FALSE(old.expired());
  }
  while (l.bench->left.size() < 6000) l.play(128);
  CHECK(old.expired());
  CHECK(l.queue.kept() == 0);
  CHECK(l.bench->reports.size() == 1);
}

TEST_CASE("With a stopped callback at most one table per strike in the queue is kept") {
  StrikeFixture l;
  int submitted = 0;
  for (int i = 0; i < 2000; ++i) submitted += l.strike(table(500), 0, i) ? 1 : 0;
  CHECK(submitted == 512);
  CHECK(l.queue.kept() < 512);
  l.play(128);
  CHECK(l.queue.kept() == 0);
}

TEST_CASE("A closed renderer releases all tables except the newest") {
  StrikeFixture l;
  for (int i = 0; i < 10; ++i) REQUIRE(l.strike(table(500), 48000, i));
  l.bench->renderer.abandon();
  l.queue.free_released();
  CHECK(l.queue.kept() == 0);
  CHECK(l.bench->queues.reports.room() + 10 == l.bench->queues.reports.capacity());
}

TEST_CASE("No strike sounds with freed modes, for any order of strikes and scenes") {
  std::mt19937 random(4);
  StrikeFixture l;
  auto of = table(300);
  for (int i = 0; i < 3000; ++i) {
    if (random() % 7 == 0) of = table(200 + random() % 3000);
    if (random() % 3 == 0) l.strike(of, static_cast<int>(random() % 4000), static_cast<std::int64_t>(random() % 40));
    if (random() % 2 == 0) l.play(1 + static_cast<int>(random() % 256));
  }
  for (const float x : l.bench->left) REQUIRE(std::abs(x) <= 1);
}
