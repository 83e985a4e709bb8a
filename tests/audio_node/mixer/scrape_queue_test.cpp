// Surfaces of previous scenes and a callback that may still read them: they are freed once it has released them,
// and never before.
#include "audio_node/mixer/scrape_queue.h"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <thread>

#include "tests/audio_node/support/bench.h"
#include "tests/audio_node/support/waves.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

// Valid sound stays below this level; the sound of freed surfaces exceeds it.
constexpr float kLoudest = 0.1f;

// As the surfaces of a scene; once freed they become so steep that a callback that reads them is audible.
ScrapeQueue::Surfaces surfaces_spoiled_on_free() {
  auto* surfaces = new AudioSurfaces;
  auto relief = std::make_shared<ReliefLevels>(make_relief(waves(), rough()));
  surfaces->by_material.push_back({relief, nullptr});
  static std::vector<std::shared_ptr<ReliefLevels>> graveyard;  // memory that is never reused
  return {surfaces, [relief](const AudioSurfaces* gone) {
            for (Eigen::Vector2f& slope : const_cast<Relief&>(relief->finest()).slopes) slope.setConstant(1e6f);
            graveyard.push_back(relief);
            delete gone;
          }};
}

// Slides along the waves of a relief at 0.1 m/s, over a body with a mode of 300 Hz.
Scrape scrape_over(const ReliefLevels* relief, std::int64_t id, std::int64_t at_ns, float strength) {
  Scrape s;
  s.id = id;
  s.at = sync::host_time(at_ns);
  s.slide = strength;
  s.place.direction = Eigen::Vector3f::UnitY();
  const Strike struck = strike_of(0, 0, 300, 50, 0);
  ScrapeSide& side = s.sides[0];
  side.voice = id;
  side.resonators = *struck.sides[0].resonators, side.gains = struck.sides[0].gains;
  side.known = true;
  side.relief = relief;
  side.velocity_m_s.x() = 0.1, side.slide_vector.x() = 1;
  return s;
}

// A loop and a callback in one thread, in alternation.
struct ScrapeFixture {
  std::unique_ptr<Bench> bench = std::make_unique<Bench>();
  ScrapeQueue queue{bench->queues};

  // Of the contact `id`, presented now or later_samples later.
  bool scrape(const ScrapeQueue::Surfaces& surfaces, std::int64_t id = 1, int later_samples = 0) {
    return queue.submit(scrape_over(surfaces->by_material[0].relief.get(), id,
                            bench->time_ns(bench->left.size() + static_cast<std::size_t>(later_samples)), 1e-4f));
  }
  // True when there was sound, and none of it from freed surfaces.
  bool sound() const {
    float loudest = 0;
    for (const float x : bench->left) loudest = std::max(loudest, std::abs(x));
    return loudest > 0 && loudest < kLoudest;
  }
};

constexpr int kBlock = 128;

}  // namespace

TEST_CASE("The surfaces of an ended scene are released when its last scrape has decayed, and not before") {
  ScrapeFixture l;
  auto first = surfaces_spoiled_on_free();
  const std::weak_ptr<const AudioSurfaces> watched = first;
  l.queue.set_surfaces(first);
  REQUIRE(l.scrape(first));
  first.reset();
  l.bench->play(kBlock);
  l.queue.set_surfaces(nullptr);
  int blocks = 0;
  while (l.bench->renderer.scraping() && blocks++ < 1000) {
    CHECK(l.queue.take_released().empty());
    REQUIRE_FALSE(watched.expired());
    l.bench->play(kBlock);
  }
  CHECK(blocks > 10);  // it sounded for at least 30 ms
  CHECK(l.queue.take_released().size() == 1);
  CHECK(watched.expired());
  CHECK(l.sound());
}

TEST_CASE("Surfaces are kept while one of their scrapes waits in the queue or for its time") {
  ScrapeFixture l;
  const auto first = surfaces_spoiled_on_free(), second = surfaces_spoiled_on_free();
  l.queue.set_surfaces(first);
  REQUIRE(l.scrape(first, 1, 4800));  // presented in 100 ms
  l.queue.set_surfaces(second);
  REQUIRE(l.scrape(second, 2, 4800));  // waits behind it
  l.queue.set_surfaces(nullptr);
  for (int n = 0; n < 4800; n += kBlock) {
    l.bench->play(kBlock);
    REQUIRE(l.queue.take_released().empty());
  }
  for (int n = 0; n < 9600; n += kBlock) l.bench->play(kBlock);
  CHECK(l.queue.take_released().size() == 2);
  CHECK(l.sound());
}

TEST_CASE("Of two scenes in quick succession the one without a scrape is released at once, the earlier one later") {
  ScrapeFixture l;
  const auto first = surfaces_spoiled_on_free(), second = surfaces_spoiled_on_free(), third = surfaces_spoiled_on_free();
  l.queue.set_surfaces(first);
  REQUIRE(l.scrape(first));
  l.bench->play(kBlock);
  l.queue.set_surfaces(second);
  l.queue.set_surfaces(third);
  const auto released = l.queue.take_released();
  REQUIRE(released.size() == 1);
  CHECK(released[0] == second);
  // The same contact continues in the new scene: its voice then reads only the new surfaces.
  REQUIRE(l.scrape(third));
  l.bench->play(kBlock);
  const auto later = l.queue.take_released();
  REQUIRE(later.size() == 1);
  CHECK(later[0] == first);
}

TEST_CASE("A stopped callback releases no surfaces that it may read, and the queue bounds their number") {
  ScrapeFixture l;
  const auto sounding = surfaces_spoiled_on_free();
  l.queue.set_surfaces(sounding);
  REQUIRE(l.scrape(sounding));
  l.bench->play(kBlock);
  std::size_t freed = 0;
  for (int scene = 0; scene < 3000; ++scene) {
    auto next = surfaces_spoiled_on_free();
    l.queue.set_surfaces(next);
    l.scrape(next, scene);
    freed += l.queue.take_released().size();
  }
  // All except those with a scrape in the queue, the sounding one and the current one.
  CHECK(freed == 3000 + 1 - l.bench->queues.scrapes.capacity() - 1 - 1);
  SECTION("the resumed callback releases all surfaces") {
    l.queue.set_surfaces(nullptr);
    for (int n = 0; n < 9600; n += kBlock) l.bench->play(kBlock);
    freed += l.queue.take_released().size();
    CHECK(freed == 3001);
    CHECK(l.sound());
  }
  SECTION("the next stream continues with the surfaces of the closed one") {
    l.queue.set_surfaces(nullptr);
    l.bench->renderer.abandon();
    freed += l.queue.take_released().size();
    CHECK(freed == 3001);
    const auto fresh = surfaces_spoiled_on_free();
    l.queue.set_surfaces(fresh);
    REQUIRE(l.scrape(fresh));
    l.queue.set_surfaces(nullptr);
    auto another = std::make_unique<Renderer>(l.bench->queues, RendererDef{});
    std::vector<float> block(2 * kBlock);
    another->render(block.data(), kBlock, {sync::host_time(l.bench->time_ns(l.bench->left.size())), {}, {}});
    CHECK(l.queue.take_released().empty());
    another->abandon();
    CHECK(l.queue.take_released().size() == 1);
  }
}

TEST_CASE("With the loop and the callback in two threads no freed surface is audible, and all are freed in the end") {
  ScrapeFixture l;
  std::atomic<bool> done{false};
  std::atomic<std::size_t> played{0};
  float loudest = 0;
  std::thread callback([&] {
    std::vector<float> block(2 * kBlock);
    // Until long after the last scrape.
    for (int quiet = 0; quiet < 100; quiet = done ? quiet + 1 : 0, played += kBlock) {
      l.bench->renderer.render(block.data(), kBlock, {sync::host_time(l.bench->time_ns(played)), {}, {}});
      for (const float x : block) loudest = std::max(loudest, std::abs(x));
      std::this_thread::yield();
    }
  });
  std::mt19937 random(6);
  std::size_t freed = 0;
  constexpr std::size_t kScenes = 400;
  for (std::size_t scene = 0; scene < kScenes; ++scene) {
    auto surfaces = surfaces_spoiled_on_free();
    l.queue.set_surfaces(surfaces);
    const ReliefLevels* relief = surfaces->by_material[0].relief.get();
    surfaces.reset();
    for (int i = 0; i < 50; ++i) {
      const auto id = static_cast<std::int64_t>(random() % 5);
      l.queue.submit(scrape_over(relief, id, l.bench->time_ns(played + random() % 1000), 1e-4f));
      freed += l.queue.take_released().size();
      std::this_thread::yield();
    }
  }
  l.queue.set_surfaces(nullptr);
  done = true;
  callback.join();
  CHECK(loudest > 0);
  CHECK(loudest < kLoudest);
  CHECK(freed + l.queue.take_released().size() == kScenes);
}

TEST_CASE(
    "An end of a scrape that does not fit is sent later unless its contact continues, and lost updates are counted") {
  auto queues = std::make_unique<CallbackQueues>();
  ScrapeQueue queue(*queues);
  const auto submit = [&](std::int64_t id, bool ends) {
    Scrape s;
    s.id = id, s.ends = ends;
    return queue.submit(s);
  };
  while (submit(1, false)) continue;
  CHECK(queue.lost() == 1);
  CHECK_FALSE(submit(1, true));
  CHECK_FALSE(submit(2, true));
  CHECK_FALSE(submit(2, false));  // it continues
  CHECK(queue.lost() == 2);
  queue.send_ends();  // there is no room yet
  std::int64_t next = 0;
  for (Scrape s; queues->scrapes.pop(s);) CHECK(s.number == next++);
  queue.send_ends();
  queue.send_ends();
  Scrape end;
  REQUIRE(queues->scrapes.pop(end));
  CHECK(end.ends);
  CHECK(end.id == 1);
  CHECK(end.number == next);
  CHECK_FALSE(queues->scrapes.pop(end));
}
