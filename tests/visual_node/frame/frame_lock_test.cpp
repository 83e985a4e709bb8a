// Walls without communication: equal frame numbers show the same instant of the world and the same sample of the
// head.
#include "visual_node/frame/frame_lock.h"

#include <catch2/catch.hpp>
#include <memory>
#include <queue>
#include <random>
#include <tactus/clock_map_t.hpp>
#include <tactus/frame_shown_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/playout_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>

#include "tests/visual_node/support/test_scene.h"

using namespace tactus;
using namespace tactus::visual;
using std::chrono::microseconds;
using std::chrono::milliseconds;

namespace {

constexpr std::int64_t kLockRun = 3;
constexpr std::int32_t kSimClock = 100;
constexpr std::int64_t kLockBegin_ns = 7'200'000'000'000;

struct SeenTimes {
  std::int64_t world_ns, head_ns, due_ns;
};

// One wall: its own clock, drawing time and received messages.
struct LockedWall {
  LockedWall(std::int32_t clock, sync::Nanoseconds ahead_of_room, Settings settings, sync::Nanoseconds draws)
      : maps(kLockRun), ahead(ahead_of_room), draws(draws), lock({kLockRun, clock, &maps}, "visual", clock) {
    settings.room = "cave4";
    scene_t scene = test::empty_scene();
    test::add_tool(scene, 0.01);
    scene.tools[0].name = "head";
    lock.load(scene, settings);
    if (clock == kSimClock) return;
    clock_map_t m{};
    m.header.run_id = kLockRun, m.header.incarnation = clock;
    m.of_clock = kSimClock, m.to_clock = clock, m.offset_ns = -ahead.count(), m.uncertainty_ns = 20'000;
    m.at_ns = kLockBegin_ns + ahead.count();
    maps.observe(m, {});
  }
  sync::HostTime to_host(std::int64_t room_ns) const { return sync::host_time(room_ns) + ahead; }

  sync::ClockMaps maps;
  sync::Nanoseconds ahead, draws;
  FrameLock lock;
  std::int64_t busy_until_ns = 0, frames = 0;
  std::map<std::int64_t, SeenTimes> seen;
  std::optional<LockedFrame> drawing;
};

// A bus and its walls, simulated in steps of 0.1 ms of the room's clock.
struct RoomBus {
  std::mt19937 random{7};
  std::vector<std::unique_ptr<LockedWall>> walls;
  double lost = 0;
  // Simulated time by the map of sim_node: sim_ns at host_ns, at this rate; the rate may change with every step.
  std::int64_t sim_ns = 0;
  double rate = 1;

  LockedWall& add(std::int32_t clock, sync::Nanoseconds ahead, sync::Nanoseconds draws, const Settings& settings = {}) {
    return *walls.emplace_back(std::make_unique<LockedWall>(clock, ahead, settings, draws));
  }
  bool arrives() { return std::uniform_real_distribution<>(0, 1)(random) >= lost; }

  void run(
      double seconds, const std::function<void(std::int64_t)>& meanwhile = [](std::int64_t) {}) {
    const std::int64_t from = t, to = from + static_cast<std::int64_t>(seconds * 1e9);
    for (; t < to; t += 100'000) {
      if (t % 1'000'000 == 0) {
        meanwhile(t);
        sim_ns += static_cast<std::int64_t>(1e6 * rate);
        publish();
      }
      for (const auto& wall : walls) draw(*wall);
    }
  }

 private:
  template <class Message>
  void send(Message m) {
    for (const auto& wall : walls)
      if (arrives())  // latency 0.1 .. 1.5 ms
        pending.emplace(t + 100'000 + static_cast<std::int64_t>(random() % 1'400'000),
                        [m, w = wall.get()](std::int64_t at) { w->lock.push(m, w->to_host(at)); });
  }
  header_t stamp(std::int64_t sim, std::int64_t incarnation, std::int64_t seq) const {
    header_t h{};
    h.sim_time_ns = sim, h.publish_time_ns = t, h.clock = kSimClock, h.run_id = kLockRun, h.incarnation = incarnation,
    h.seq = seq;
    return h;
  }
  void publish() {
    const std::int64_t ms = t / 1'000'000;
    if (ms % 17 == 0) {
      world_state_t w{};
      w.header = stamp(sim_ns, 50, ms);
      w.clock.sim_ns = sim_ns, w.clock.host_ns = t, w.clock.rate = rate;
      w.pages = 1;
      send(w);
    }
    tool_state_t head{};
    head.header = stamp(-1, 60, ms);
    head.device.orientation.w = 1;
    send(head);
    if (ms % 100 == 0) {
      playout_t p{};
      p.header = stamp(-1, 70, ms);
      p.entries.resize(1), p.count = 1;
      p.entries[0].modality = "visual", p.entries[0].delay_ns = asked_ns;
      send(p);
    }
    for (; !pending.empty() && pending.begin()->first <= t; pending.erase(pending.begin()))
      pending.begin()->second(t);
  }
  // As in the loop: begin at the best time, draw, hold until due.
  void draw(LockedWall& w) {
    if (t < w.busy_until_ns) return;
    const auto room_of = [&](sync::HostTime to_host) { return sync::to_ns(to_host - w.ahead); };
    if (!w.drawing) {
      w.drawing = w.lock.begin_frame(w.to_host(t));
      if (!w.drawing) {
        w.busy_until_ns = t + 16'666'667;
        return;
      }
      const auto jitter = microseconds(random() % 1500);
      w.lock.add_draw_times(w.draws + jitter, microseconds(800));
      const std::int64_t ready = t + (w.draws + jitter + microseconds(800)).count();
      w.busy_until_ns = std::max(ready, room_of(w.drawing->due_host_time));
      // A frame is never shown before it is due, nor held for longer than a period.
      held_ns = std::max(held_ns, w.busy_until_ns - ready);
      return;
    }
    const LockedFrame& f = *w.drawing;
    REQUIRE(w.seen.count(f.number) == 0);
    if (!w.seen.empty()) REQUIRE(f.number > w.seen.rbegin()->first);
    w.seen[f.number] = {sync::to_ns(f.sim_time), f.head_ns, sync::to_ns(f.due)};
    late_ns = std::max(late_ns, t - sync::to_ns(f.due));
    w.drawing.reset();
    w.busy_until_ns = std::max(t, room_of(w.lock.next_begin(w.to_host(t))));
  }

 public:
  std::int64_t t = kLockBegin_ns, held_ns = 0, late_ns = 0, asked_ns = 0;
  std::multimap<std::int64_t, std::function<void(std::int64_t)>> pending;
};

// Number of frames that both walls have shown, and the shares with the same instant and with the same head; without
// the first second.
struct Common {
  int frames = 0, world = 0, head = 0;
};
Common common(const LockedWall& a, const LockedWall& b) {
  Common c;
  for (const auto& [number, x] : a.seen) {
    const auto y = b.seen.find(number);
    if (y == b.seen.end() || x.due_ns < kLockBegin_ns + 1'000'000'000) continue;
    CHECK(x.due_ns == y->second.due_ns);
    ++c.frames, c.world += x.world_ns == y->second.world_ns, c.head += x.head_ns == y->second.head_ns;
  }
  return c;
}

}  // namespace

TEST_CASE("Walls with different clocks draw each frame at one time with one head pose and skip none") {
  RoomBus room;
  room.add(kSimClock, {}, milliseconds(5));
  room.add(2, std::chrono::hours(1), milliseconds(9));
  room.add(3, -std::chrono::minutes(50), milliseconds(12));
  room.run(6);
  for (const auto& wall : room.walls) {
    const Common c = common(*room.walls[0], *wall);
    CHECK(c.frames >= 298);  // 5 s at 60 Hz
    CHECK(c.world == c.frames);
    CHECK(c.head == c.frames);
  }
  // Ready by the second longest of nine and a margin: jitter of 1.5 ms, a step of the test, a margin.
  CHECK(room.held_ns < 4'000'000 + 16'700'000);
}

TEST_CASE("A wall that needs 100 ms shows every sixth or seventh frame at the time of the others") {
  Settings settings;
  settings.frame_lag_s = 0.12;  // longer than it draws: then the head is the same too
  RoomBus room;
  room.add(kSimClock, {}, milliseconds(5), settings);
  room.add(2, std::chrono::hours(1), milliseconds(100), settings);
  room.run(10);
  const Common c = common(*room.walls[0], *room.walls[1]);
  CHECK(c.frames > 70);
  CHECK(c.frames < 95);
  CHECK(c.world == c.frames);
  CHECK(c.head == c.frames);
  CHECK(room.walls[0]->seen.size() > 590);  // the fast wall misses no frame
}

TEST_CASE("With a short lag a slow wall draws the same time with an older head pose and reports it") {
  RoomBus room;
  room.add(kSimClock, {}, milliseconds(5));
  LockedWall& slow = room.add(2, std::chrono::hours(1), milliseconds(100));
  room.run(6);
  const Common c = common(*room.walls[0], slow);
  REQUIRE(c.frames > 30);
  CHECK(c.world == c.frames);
  CHECK(c.head == 0);
  CHECK(slow.lock.status_text(slow.to_host(room.t)).find("frame_lag") != std::string::npos);
  CHECK(room.walls[0]->lock.status_text(room.walls[0]->to_host(room.t)).empty());
}

TEST_CASE("Walls stay together while the simulation slows down, pauses and resumes") {
  RoomBus room;
  room.add(kSimClock, {}, milliseconds(4));
  room.add(2, milliseconds(777), milliseconds(11));
  room.run(2);
  for (const double rate : {0.37, 0.0, 1.0, 0.0, 0.92, 1.0}) {
    room.rate = rate;
    room.run(1);
  }
  std::mt19937 random(9);  // a machine that is too slow: another rate with every step
  room.run(3, [&](std::int64_t) { room.rate = 0.2 + 1e-3 * static_cast<double>(random() % 900); });
  const Common c = common(*room.walls[0], *room.walls[1]);
  CHECK(c.frames >= 590);
  CHECK(c.world == c.frames);
  CHECK(c.head == c.frames);
}

TEST_CASE(
    "A new presentation delay applies to all walls and moves the world but not the head") {
  RoomBus room;
  LockedWall& a = room.add(kSimClock, {}, milliseconds(4));
  LockedWall& b = room.add(2, milliseconds(777), milliseconds(11));
  room.asked_ns = 40'000'000;
  room.run(3);
  room.asked_ns = 15'000'000;
  room.run(3);
  const Common c = common(a, b);
  CHECK(c.frames >= 298);
  CHECK(c.world == c.frames);
  const SeenTimes& last = a.seen.rbegin()->second;
  // The world began at kBegin at rate 1. It is published at the end of each ms, so it is 1 ms ahead.
  CHECK(last.due_ns - kLockBegin_ns - last.world_ns == 15'000'000 - 1'000'000);
  // The head is the newest sample of 1 kHz that is older than the lag.
  CHECK(last.due_ns - last.head_ns >= 25'000'000);
  CHECK(last.due_ns - last.head_ns < 26'000'000);
}

TEST_CASE("With 1 % of the messages lost, 99 % of the frames match") {
  RoomBus room;
  room.lost = 0.005;  // for each of the two walls
  room.add(kSimClock, {}, milliseconds(4));
  room.add(2, milliseconds(777), milliseconds(11));
  room.run(21);
  const Common c = common(*room.walls[0], *room.walls[1]);
  CHECK(c.frames >= 1195);
  // At real-time rate every map describes the same line. The head differs only when exactly the newest sample of
  // 1 kHz is lost, or the border falls between: 1 % and three standard deviations of 1200 trials, 0.9 %.
  CHECK(c.world == c.frames);
  CHECK(c.head >= 0.981 * c.frames);
}

TEST_CASE("A slow wall does not delay other walls") {
  RoomBus alone, beside;
  alone.add(kSimClock, {}, milliseconds(5));
  beside.add(kSimClock, {}, milliseconds(5));
  beside.add(2, milliseconds(777), milliseconds(250));
  alone.run(4), beside.run(4);
  CHECK(alone.walls[0]->seen.size() == beside.walls[0]->seen.size());
}

TEST_CASE("There is no lock without a room, with the lock off, or before the first message of sim_node") {
  sync::ClockMaps maps(kLockRun);
  const auto locked = [&](const char* room, const char* mode, bool received) {
    FrameLock lock({kLockRun, kSimClock, &maps}, "visual", 1);
    Settings s;
    s.room = room, s.frame_lock = mode;
    lock.load(test::empty_scene(), s);
    world_state_t w{};
    w.header.run_id = kLockRun, w.header.clock = kSimClock, w.header.incarnation = 5,
    w.header.publish_time_ns = kLockBegin_ns;
    w.clock.host_ns = kLockBegin_ns, w.clock.rate = 1;
    if (received) lock.push(w, sync::host_time(kLockBegin_ns));
    return lock.begin_frame(sync::host_time(kLockBegin_ns + 50'000'000)).has_value();
  };
  CHECK(locked("cave4", "time", true));
  CHECK(locked("cave4", "wait", true));
  CHECK_FALSE(locked("cave4", "off", true));
  CHECK_FALSE(locked("none", "time", true));
  CHECK_FALSE(locked("cave4", "time", false));
}

TEST_CASE("FRAME_SHOWN contains number, due time, simulated time and head pose of a frame") {
  RoomBus room;
  LockedWall& wall = room.add(kSimClock, {}, milliseconds(5));
  room.run(2);
  const LockedFrame frame = *wall.lock.begin_frame(wall.to_host(room.t));
  const frame_shown_t m = wall.lock.message(frame, frame_shown_t::SHOWN);
  CHECK(m.frame == frame.number);
  CHECK(m.due_ns == std::llround(static_cast<double>(frame.number) * 1e9 / 60));
  CHECK(m.header.sim_time_ns == sync::to_ns(frame.sim_time));
  CHECK(m.head_ns == frame.head_ns);
  CHECK(frame.head.status == sync::SampleStatus::kExtrapolated);
  CHECK(m.stage == frame_shown_t::SHOWN);
}

TEST_CASE("After a stall a wall detects missing inputs of its next frame") {
  RoomBus room;
  LockedWall& wall = room.add(2, std::chrono::hours(1), milliseconds(9));
  CHECK(wall.lock.inputs_complete(wall.to_host(room.t)));  // no lock before the first message
  room.run(1);
  CHECK(wall.lock.inputs_complete(wall.to_host(room.t)));
  // Head and clock are those published frame_lag before the due time of the frame, which comes one drawing time
  // after its begin.
  CHECK(wall.lock.inputs_complete(wall.to_host(room.t) + milliseconds(5)));
  CHECK_FALSE(wall.lock.inputs_complete(wall.to_host(room.t) + milliseconds(200)));
  room.run(0.205);  // the world publishes every 17 ms, the last time 5 ms ago
  CHECK(wall.lock.inputs_complete(wall.to_host(room.t)));
}
