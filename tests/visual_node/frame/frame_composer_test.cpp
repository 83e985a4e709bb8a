#include "visual_node/frame/frame_composer.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <map>
#include <random>
#include <tactus/body_state_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/sim_clock_t.hpp>
#include <tactus/world_state_t.hpp>

#include "tests/visual_node/support/test_scene.h"

using namespace tactus;
using namespace tactus::visual;
using std::chrono::milliseconds;

namespace {

constexpr std::int64_t kRun = 3;
// Host time at which the world began.
constexpr std::int64_t kBegan_ns = 10'000'000'000;
constexpr sync::Nanoseconds kFrame{16'666'667};

sim_clock_t clock_at(std::int64_t sim_ns) {
  sim_clock_t clock{};
  clock.sim_ns = sim_ns;
  clock.host_ns = sim_ns + kBegan_ns;
  clock.rate = 1;
  return clock;
}

header_t header_at(std::int64_t sim_ns) {
  header_t h{};
  h.sim_time_ns = sim_ns;
  h.publish_time_ns = sim_ns + kBegan_ns;
  h.run_id = kRun;
  h.incarnation = 9;
  return h;
}

// Body 0 moves along +x at 1 m/s from x = 2.
world_state_t world_at(std::int64_t sim_ns) {
  world_state_t m{};
  m.header = header_at(sim_ns);
  m.clock = clock_at(sim_ns);
  m.pages = m.count = 1;
  body_state_t body{};
  body.position_m.x = 2 + 1e-9 * static_cast<double>(sim_ns);
  body.orientation.w = 1;
  body.velocity_m_s.x = 1;
  m.bodies = {body};
  return m;
}

contact_events_t event_at(std::int64_t sim_ns, std::int64_t id) {
  contact_events_t m{};
  m.header = header_at(sim_ns);
  m.clock = clock_at(sim_ns);
  m.pages = m.count = 1;
  contact_event_t e{};
  e.event_id = id;
  e.time_ns = sim_ns;
  e.kind = contact_event_t::BEGIN;
  e.normal.z = 1;
  e.point_m.x = 2;
  m.events = {e};
  return m;
}

struct Fixture {
  FrameComposer composer{kRun, Settings{}};
  std::map<std::int64_t, int> outcomes;
  std::map<std::int64_t, presentation_t> reports;
  sync::Nanoseconds delay{0}, held{0};
  std::int64_t number = 0;

  void load() {
    scene_t scene = test::empty_scene();
    test::add_visual(scene, test::add_body(scene, {2, 0, 0}), shape_def_t::SPHERE, {0.1, 0, 0});
    composer.load(scene, {}, Settings{});
  }
  // One frame at host time `now_ns`: 3 ms for its surfaces, 1 ms for its flashes. meanwhile: called in between.
  Frame frame(
      std::int64_t sim_ns, const std::function<void()>& meanwhile = [] {}) {
    const sync::HostTime now = sync::host_time(sim_ns + kBegan_ns);
    Frame f = composer.frame(now, number++, delay);
    meanwhile();
    composer.latch(f, now + milliseconds(3), delay, held);
    for (const presentation_t& r : composer.presented(now + milliseconds(4))) {
      CHECK(reports.count(r.event_id) == 0);
      outcomes[r.event_id] = r.outcome;
      reports[r.event_id] = r;
    }
    return f;
  }
  void receive(std::int64_t sim_ns) { composer.push(world_at(sim_ns), sync::host_time(sim_ns + kBegan_ns)); }
};

float x_of(const Frame& f) { return f.list.instances.at(0).position.x(); }

}  // namespace

TEST_CASE_METHOD(Fixture, "A frame shows the world at the instant at which it is presented") {
  load();
  std::int64_t t = 0;
  Frame f;
  for (int i = 0; i < 20; ++i, t += kFrame.count()) receive(t), f = frame(t);
  t -= kFrame.count();
  CHECK(f.state == node_health_t::RUNNING);
  CHECK(f.status == sync::SampleStatus::kExtrapolated);
  CHECK(x_of(f) == Approx(2 + 1e-9 * static_cast<double>(t) + 0.004).margin(1e-6));  // 4 ms ahead at 1 m/s
}

TEST_CASE_METHOD(Fixture, "The status word follows the size and the contrast of texts during a run, and stays in the picture") {
  // The plate of the word and its letters, which are drawn last; before them come the cells of the markers.
  const auto word_of = [](const Frame& f) {
    const auto plate = std::find_if(f.list.overlay.begin(), f.list.overlay.end(), [](const Rect& r) { return r.x == 8 && r.y == 8; });
    return std::vector<Rect>(plate, f.list.overlay.end());
  };
  const auto usual = word_of(frame(0));
  REQUIRE(usual.size() > 20);
  Settings changed;
  changed.text_size = 2, changed.text_contrast = "high";
  composer.change(changed);
  const auto twice = word_of(frame(16'000'000));
  REQUIRE(twice.size() == usual.size());
  CHECK(twice[0].height == 2 * usual[0].height);
  CHECK(twice[0].alpha == 1);
  CHECK(twice[1].height == 2 * usual[1].height);
  changed.text_size = 4;
  composer.change(changed);
  for (const Rect& r : word_of(frame(32'000'000))) CHECK(r.x + r.width <= 640);
}

TEST_CASE_METHOD(Fixture,
                 "Before the scene arrives a frame is dark and shows WAITING") {
  Frame f = frame(0);
  CHECK(f.state == node_health_t::WAITING);
  CHECK(f.list.instances.empty());
  CHECK_FALSE(f.list.overlay.empty());
  load();
  f = frame(16'000'000);
  CHECK(f.state == node_health_t::READY);
  CHECK(x_of(f) == Approx(2));  // its pose in the scene
  receive(30'000'000);
  CHECK(frame(32'000'000).state == node_health_t::RUNNING);
}

TEST_CASE_METHOD(
    Fixture,
    "Without new state bodies are extrapolated, then held, then shown as lost") {
  load();
  receive(0);
  frame(0);
  CHECK(frame(40'000'000).state == node_health_t::RUNNING);
  const Frame held = frame(100'000'000);
  CHECK(held.state == node_health_t::STALE);
  CHECK(x_of(held) == Approx(2.05));
  CHECK(frame(250'000'000).state == node_health_t::STALE);
  CHECK(frame(600'000'000).state == node_health_t::INPUT_LOST);
  CHECK(x_of(frame(5'000'000'000)) == Approx(2.05));
  receive(5'100'000'000);
  CHECK(frame(5'100'000'000).state == node_health_t::RUNNING);
}

TEST_CASE_METHOD(Fixture, "After a stop of two seconds one frame is stale and the next is current") {
  load();
  std::int64_t t = 0;
  for (int i = 0; i < 20; ++i, t += kFrame.count()) receive(t), frame(t);
  t += 2'000'000'000;
  CHECK(frame(t).state == node_health_t::STALE);
  t += kFrame.count();
  receive(t);
  const Frame f = frame(t);
  CHECK(f.state == node_health_t::RUNNING);
  CHECK(x_of(f) == Approx(2 + 1e-9 * static_cast<double>(t)).margin(0.01));
}

TEST_CASE_METHOD(Fixture,
                 "A contact flashes in the first frame at or after its time and is reported once") {
  load();
  for (int i = 0; i < 10; ++i) receive(i * kFrame.count()), frame(i * kFrame.count());
  const std::int64_t t = 10 * kFrame.count();
  receive(t);
  composer.push(event_at(t - 1'000'000, 71), sync::host_time(t + kBegan_ns));
  composer.push(event_at(t + 3'900'000, 72),
                sync::host_time(t + kBegan_ns));  // within the drawing time
  composer.push(event_at(t + 4'100'000, 73), sync::host_time(t + kBegan_ns));
  const Frame f = frame(t);
  CHECK_FALSE(f.list.glows.empty());
  CHECK(outcomes == std::map<std::int64_t, int>{{71, presentation_t::PRESENTED}, {72, presentation_t::PRESENTED}});
  frame(t + kFrame.count());
  CHECK(outcomes.count(73) == 1);
  for (int i = 2; i < 10; ++i) frame(t + i * kFrame.count());
  CHECK(outcomes.size() == 3);
}

TEST_CASE_METHOD(Fixture, "An event that arrives while the surfaces are drawn flashes in the same frame") {
  load();
  for (int i = 0; i < 10; ++i) receive(i * kFrame.count()), frame(i * kFrame.count());
  const std::int64_t t = 10 * kFrame.count();
  const Frame f =
      frame(t, [&] { composer.push(event_at(t + 1'000'000, 71), sync::host_time(t + 2'000'000 + kBegan_ns)); });
  CHECK_FALSE(f.list.glows.empty());
  REQUIRE(reports.count(71) == 1);
  CHECK(reports[71].presented_ns - reports[71].scheduled_ns == 3'000'000);
  SECTION("its flash is not older than the frame") {
    const Frame later = frame(t + kFrame.count());
    REQUIRE(later.list.glows.size() == f.list.glows.size());
    CHECK(f.list.glows[0].centre.w() == 0);
    CHECK(later.list.glows[0].centre.w() ==
          Approx(sync::to_seconds(kFrame) / Settings{}.flash_duration_s).epsilon(1e-3));
  }
}

TEST_CASE_METHOD(Fixture,
                 "A delayed event is shown in the nearest frame, at most half a frame off") {
  load();
  delay = milliseconds(GENERATE(9, 17, 30, 45));
  std::mt19937 random(7);
  std::int64_t id = 100;
  for (int i = 0; i < 400; ++i) {
    const std::int64_t t = i * kFrame.count();
    receive(t);
    if (i > 10 && i < 390)
      composer.push(event_at(t - static_cast<std::int64_t>(random() % 5'000'000), ++id),
                    sync::host_time(t + kBegan_ns));
    frame(t);
  }
  REQUIRE(reports.size() == static_cast<std::size_t>(id - 100));
  for (const auto& [event_id, r] : reports)
    CHECK(std::abs(r.presented_ns - r.scheduled_ns) <= kFrame.count() / 2 + 1);
}

TEST_CASE_METHOD(
    Fixture,
    "At a low picture rate an event is shown in the first picture at or after its time") {
  load();
  const int every = GENERATE(6, 30);  // ticks: 10 and 2 pictures a second
  delay = milliseconds(GENERATE(0, 40));
  held = every * kFrame;
  std::mt19937 random(7);
  std::int64_t id = 100;
  std::map<std::int64_t, std::int64_t> due;
  std::vector<std::int64_t> fences;
  for (int i = 0; i < 600; ++i) {
    const std::int64_t t = i * kFrame.count();
    receive(t);
    if (i > 60 && i < 500) {
      due[++id] = t - static_cast<std::int64_t>(random() % 1'000'000) + delay.count() + kBegan_ns;
      composer.push(event_at(due[id] - delay.count() - kBegan_ns, id), sync::host_time(t + kBegan_ns));
    }
    if (i % every == 0) frame(t), fences.push_back(t + 4'000'000 + kBegan_ns);
  }
  REQUIRE(reports.size() == due.size());
  for (const auto& [event_id, r] : reports) {
    CHECK(r.scheduled_ns == due[event_id]);
    CHECK(r.presented_ns == *std::lower_bound(fences.begin(), fences.end(), due[event_id]));
    CHECK(r.outcome ==
          (r.presented_ns - r.scheduled_ns > 50'000'000 ? presentation_t::LATE : presentation_t::PRESENTED));
  }
}

TEST_CASE_METHOD(Fixture, "The lateness settings of a new scene apply to its events") {
  load();
  scene_t scene = test::empty_scene();
  Settings settings;
  settings.late_after_s = 0.01, settings.drop_after_s = 0.1;
  composer.load(scene, {}, settings);
  receive(0);
  frame(0);
  receive(1'000'000'000);
  composer.push(event_at(1'000'000'000 - 20'000'000, 1), sync::host_time(1'000'000'000 + kBegan_ns));
  composer.push(event_at(1'000'000'000 - 120'000'000, 2), sync::host_time(1'000'000'000 + kBegan_ns));
  frame(1'000'000'000);
  CHECK(outcomes == std::map<std::int64_t, int>{{1, presentation_t::LATE}, {2, presentation_t::DROPPED_LATE}});
}

TEST_CASE_METHOD(Fixture, "Events during a stall are shown late or dropped, and each is reported") {
  load();
  receive(0);
  frame(0);
  for (std::int64_t i = 1; i <= 20; ++i)
    composer.push(event_at(i * 100'000'000, i), sync::host_time(2'000'000'000 + kBegan_ns));
  receive(2'000'000'000);
  const Frame f = frame(2'000'000'000);
  CHECK_FALSE(f.list.glows.empty());
  REQUIRE(outcomes.size() == 20);
  CHECK(outcomes[1] == presentation_t::DROPPED_LATE);
  CHECK(outcomes[17] == presentation_t::DROPPED_LATE);
  CHECK(outcomes[18] == presentation_t::LATE);
  CHECK(outcomes[20] == presentation_t::PRESENTED);
}

TEST_CASE_METHOD(Fixture, "An event without a scene waits, and is dropped when it is too late") {
  composer.push(event_at(0, 5), sync::host_time(kBegan_ns));
  frame(10'000'000);
  CHECK(outcomes.empty());
  frame(300'000'000);
  CHECK(outcomes == std::map<std::int64_t, int>{{5, presentation_t::DROPPED_LATE}});
}
