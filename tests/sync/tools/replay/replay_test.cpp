// Tests of replaying a log: speed, pause, seek, damage and new stamps.
#include "sync/tools/replay/replay.h"

#include <catch2/catch.hpp>
#include <random>
#include <tactus/node_health_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/log/log_header.h"
#include "sync/tools/replay/replay_selection.h"
#include "sync/tools/replay/replay_control.h"
#include "tests/sync/support/damaged_log.h"

using namespace tactus;
using namespace tactus::sync;

namespace {
constexpr Nanoseconds kTick{1'000'000};
const HostTime kNow = host_time(900'000'000'000);

LogIndex index_of(const std::vector<std::uint8_t>& bytes) {
  LogIndex index(bytes);
  index.read_all();
  return index;
}

// 1,200 messages, 1 ms apart, and their player.
struct Player {
  DamagedLog log{1200};
  LogIndex index = index_of(log.bytes);
  HostTime now = kNow;
  Replay replay;
  std::vector<std::int64_t> numbers;
  std::vector<HostTime> at;
  std::vector<ReplayMoment> moments;

  explicit Player(const ReplayOptions& options = {}) : replay(index, 1, options, now) {}
  void play(Nanoseconds d) {
    for (const HostTime end = now + d; now < end;) {
      now += kTick;
      replay.poll(now, [&](const LogEvent& e, const ReplayMoment& m) {
        numbers.push_back(e.number), at.push_back(now), moments.push_back(m);
        return true;
      });
    }
  }
};

LogEvent event_of(const std::string& channel, const std::vector<std::uint8_t>& data) {
  return {0, 0, channel, data};
}

}  // namespace

TEST_CASE("A log is replayed at its recorded pace, completely and in order") {
  Player p;
  p.play(Nanoseconds(1'250'000'000));
  REQUIRE(p.numbers.size() == 1200);
  for (std::size_t i = 0; i < p.numbers.size(); ++i) {
    CHECK(p.numbers[i] == static_cast<std::int64_t>(i));
    const Nanoseconds late = p.at[i] - kNow - Nanoseconds(static_cast<std::int64_t>(i) * 1'000'000);
    CHECK(late >= Nanoseconds(-2000));
    CHECK(late <= 2 * kTick);
  }
  CHECK(p.replay.over());
  CHECK(p.replay.length_s() == Approx(1.199));
  CHECK(p.replay.behind_s() == 0);
}

TEST_CASE("Each message is sent once at any speed") {
  const auto speed = GENERATE(0.1, 0.5, 3.0, 10.0, 0.0);
  ReplayOptions o;
  o.speed = speed;
  Player p(o);
  p.play(Nanoseconds(static_cast<std::int64_t>(1.3e9 / (speed == 0 ? 10 : speed))));
  CHECK(p.replay.over());
  REQUIRE(p.numbers.size() == 1200);
  CHECK(std::is_sorted(p.numbers.begin(), p.numbers.end()));
  if (speed == 0) return;
  for (std::size_t i = 1; i < p.moments.size(); ++i) {
    const double live = static_cast<double>((p.moments[i].live - p.moments[0].live).count());
    CHECK(std::abs(live * speed - static_cast<double>((p.moments[i].recorded - p.moments[0].recorded).count())) <=
          1 + 2 * speed);
  }
}

TEST_CASE("Bursts and rate stay within their limits at any speed") {
  ReplayOptions o;
  o.speed = GENERATE(0.0, 100.0);
  o.max_per_s = 2000;
  Player p(o);
  std::size_t before = 0;
  for (int i = 0; i < 5000 && !p.replay.over(); ++i) {
    p.play(kTick);
    CHECK(p.numbers.size() - before <= static_cast<std::size_t>(Replay::kBurst));
    before = p.numbers.size();
  }
  CHECK(p.numbers.size() == 1200);
  CHECK(p.now - kNow >= Nanoseconds(580'000'000));
  CHECK((p.replay.behind_s() > 0) == (o.speed > 0));
}

TEST_CASE("A replay that was blocked for seconds continues without a burst") {
  Player p;
  p.play(Nanoseconds(300'000'000));
  const std::size_t before = p.numbers.size();
  p.now += Nanoseconds(5'000'000'000);
  p.play(kTick);
  CHECK(p.numbers.size() - before <= static_cast<std::size_t>(Replay::kBurst));
  p.play(Nanoseconds(950'000'000));
  CHECK(p.numbers.size() == 1200);
  CHECK(p.replay.behind_s() == Approx(5).margin(0.1));
}

TEST_CASE("A paused replay sends nothing and resumes with the next message") {
  Player p;
  p.play(Nanoseconds(200'000'000));
  p.replay.pause(p.now);
  const auto sent = p.numbers.size();
  p.play(Nanoseconds(700'000'000));
  CHECK(p.numbers.size() == sent);
  p.replay.resume(p.now);
  p.play(Nanoseconds(1'050'000'000));
  CHECK(p.numbers.size() == 1200);
  CHECK(std::is_sorted(p.numbers.begin(), p.numbers.end()));
  SECTION("live times never decrease") {
    for (std::size_t i = 1; i < p.moments.size(); ++i) CHECK(p.moments[i].live >= p.moments[i - 1].live);
  }
}

TEST_CASE("A step replays its duration and then pauses") {
  ReplayOptions o;
  o.paused = true;
  Player p(o);
  p.play(Nanoseconds(100'000'000));
  CHECK(p.numbers.empty());
  for (int step = 1; step <= 3; ++step) {
    p.replay.step(0.1, p.now);
    p.play(Nanoseconds(500'000'000));
    CHECK(p.replay.paused());
    CHECK(p.replay.position_s() == Approx(0.1 * step).margin(1e-6));
    CHECK(std::abs(static_cast<int>(p.numbers.size()) - 100 * step) <= 1);
  }
}

TEST_CASE("A replay can seek to any time") {
  Player p;
  std::mt19937 random(3);
  for (int i = 0; i < 50; ++i) {
    const double to_s = (random() % 1190) * 1e-3;
    const std::int64_t pass = p.replay.passes();
    p.replay.seek(to_s, p.now);
    CHECK(p.replay.passes() == pass + 1);
    p.numbers.clear();
    p.play(2 * kTick);
    REQUIRE(!p.numbers.empty());
    CHECK(std::abs(p.numbers.front() - static_cast<std::int64_t>(to_s * 1000 + 0.5)) <= 1);
  }
  p.replay.seek(-5, p.now);
  CHECK(p.replay.position_s() == 0);
  p.replay.seek(1e300, p.now);
  CHECK(p.replay.position_s() == p.replay.length_s());
}

TEST_CASE("A range of a log is replayed in a loop") {
  ReplayOptions o;
  o.start_s = 0.2, o.end_s = 0.3, o.loop = true;
  Player p(o);
  p.play(Nanoseconds(1'000'000'000));
  CHECK_FALSE(p.replay.over());
  CHECK(p.replay.passes() >= 8);
  for (const std::int64_t n : p.numbers) CHECK((n >= 199 && n <= 301));
  p.replay.set_loop(false);
  p.play(Nanoseconds(200'000'000));
  CHECK(p.replay.over());
}

TEST_CASE("Invalid options are rejected with one sentence") {
  DamagedLog log(10);
  const LogIndex index = index_of(log.bytes);
  const auto with = [&](double start, double end, double speed) {
    ReplayOptions o;
    o.start_s = start, o.end_s = end, o.speed = speed;
    Replay(index, 1, o, kNow);
  };
  CHECK_THROWS_WITH(with(5, -1, 1), Catch::Contains("--start"));
  CHECK_THROWS_WITH(with(0.005, 0.001, 1), Catch::Contains("--start"));
  CHECK_THROWS_WITH(with(0, -1, 1000), Catch::Contains("speed"));
  CHECK_THROWS_WITH(Replay(LogIndex({}), 1, {}, kNow), Catch::Contains("not an LCM log"));
}

TEST_CASE("1,000 damaged logs are replayed to their end with their undamaged messages") {
  const DamagedLog sound(120);
  for (unsigned seed = 0; seed < 1000; ++seed) {
    std::mt19937 random(seed);
    DamagedLog log = sound;
    log.damage(random);
    const LogIndex index = index_of(log.bytes);
    ReplayOptions o;
    o.speed = 0;
    o.max_per_s = 1e6;
    Replay replay(index, 1, o, kNow);
    std::set<std::int64_t> missing = log.whole;
    HostTime now = kNow;
    for (int i = 0; i < 100 && !replay.over(); ++i)
      replay.poll(now += kTick, [&](const LogEvent& e, const ReplayMoment&) {
        missing.erase(e.number);
        return true;
      });
    INFO("seed " << seed);
    CHECK(replay.over());
    missing.erase(0);    // LOG_INFO is not in the live part
    missing.erase(119);  // a damaged neighbour may hide the end of the log
    CHECK(missing.size() <= 1);
  }
}

TEST_CASE("Recorded stamps are mapped to live time within 3 ns at any speed") {
  const Identity live{"replay", 9, 1234, 5678, 4242};
  LogOrigin origin;
  origin.info.header.run_id = 77;
  origin.info.header.clock = 11;
  const double speed = GENERATE(0.1, 1.0, 8.0);
  ReplayStamps stamps(origin, live);
  world_state_t m{};
  m.header = header_of("sim_node", 31, 5, 0, 77);
  m.header.clock = 11;
  m.pages = 1;
  std::mt19937 random(2);
  for (int i = 0; i < 100; ++i) {
    // Sent every 16 ms, up to 3 ms before it arrived; with a clock pair up to 1 s old, at half speed.
    const std::int64_t sent = std::int64_t{1'000'000'000} + 16'000'000 * i,
                       arrived = sent + static_cast<std::int64_t>(random() % 3'000'000);
    m.header.publish_time_ns = sent;
    m.header.seq = i;
    m.clock = {500'000'000 + i, sent - static_cast<std::int64_t>(random() % 1'000'000'000), 0.5};
    auto bytes = encode(m);
    const HostTime live_at =
        kNow + Nanoseconds(static_cast<std::int64_t>(static_cast<double>(arrived - 1'000'000'000) / speed));
    INFO("message " << i << ", " << bytes.size() << " bytes");
    REQUIRE(stamps.restamp(bytes, {host_time(arrived), live_at, speed, 0}, live_at + kTick));
    const auto out = decode<world_state_t>(bytes.data(), bytes.size());
    REQUIRE(out);
    CHECK(out->header.run_id == live.run_id);
    CHECK(out->header.clock == live.clock);
    CHECK(out->header.source == m.header.source);
    CHECK(out->header.seq == i);
    // The oracle: one line from recorded to live time.
    const auto live_of = [&](std::int64_t recorded_ns) {
      return to_ns(kNow) +
             static_cast<std::int64_t>(std::llround(static_cast<double>(recorded_ns - 1'000'000'000) / speed));
    };
    CHECK(std::abs(out->header.publish_time_ns - live_of(sent)) <= 3);
    CHECK(std::abs(out->clock.host_ns - live_of(m.clock.host_ns)) <= 3);
    CHECK(out->clock.sim_ns == m.clock.sim_ns);
    CHECK(out->clock.rate == Approx(0.5 * speed));
  }
}

TEST_CASE("Senders get a new incarnation after a jump and keep it otherwise") {
  const Identity live{"replay", 9, 1234, 5678, 4242};
  LogOrigin origin;
  origin.info.header.run_id = 77;
  ReplayStamps stamps(origin, live);
  const auto incarnation = [&](std::int64_t pass, std::int64_t recorded) {
    node_health_t m{};
    m.header = header_of("some_node", recorded, 1, 1000, 77);
    auto bytes = encode(m);
    REQUIRE(stamps.restamp(bytes, {host_time(2000), kNow, 1, pass}, kNow));
    return peek_header(bytes.data(), bytes.size())->incarnation;
  };
  const std::int64_t first = incarnation(0, 5);
  CHECK(incarnation(0, 5) == first);
  CHECK(incarnation(0, 6) != first);
  CHECK(incarnation(1, 5) != first);
}

TEST_CASE("Damaged time stamps cause no overflow, and foreign messages are unchanged") {
  LogOrigin origin;
  origin.info.header.run_id = 77;
  ReplayStamps stamps(origin, Identity{"replay", 9, 1234, 5678, 4242});
  std::mt19937_64 random(7);
  world_state_t m{};
  m.header = header_of("sim_node", 31, 5, 0, 77);
  m.pages = 1;
  const auto sound = encode(m);
  for (int i = 0; i < 20'000; ++i) {
    auto bytes = sound;
    for (int n = 0; n < 8; ++n) bytes[8 + random() % (bytes.size() - 8)] = static_cast<std::uint8_t>(random());
    stamps.restamp(
        bytes,
        {host_time(static_cast<std::int64_t>(random() >> 3)), kNow, 0.01 + (random() % 10000) * 0.01, i % 7},
        kNow);
  }
  std::vector<std::uint8_t> foreign(20, 0xff);
  const auto before = foreign;
  CHECK_FALSE(stamps.restamp(foreign, {kNow, kNow, 1, 0}, kNow));
  CHECK(foreign == before);
}

TEST_CASE("By default only channels of the world are replayed, not those of the nodes") {
  ReplaySelection selection({});
  for (const char* c :
       {"TOUCH_MODEL", "CONTACT_EVENTS", "CONTACTS", "WORLD_STATE", "GAME_STATE", "TOOL_STATE", "MY_OWN"})
    CHECK(selection.channel_of(event_of(c, {})) == std::string_view(c));
  for (const char* c : {"NODE_HEALTH", "PRESENTED", "SYNC_REPORT", "CLOCK_MAP", "CLOCK_PROBE", "PLAYOUT",
                        "PLAYOUT_REQUEST", "DEGRADATION", "DEGRADED", "SETTING", "QUESTION", "ANSWER", "SIM_COMMAND", "DEVICE_FORCE",
                        "THERMAL_STATE", "MEDIA_CLOCK", "SCENE_MANIFEST", "LOG_INFO"})
    CHECK_FALSE(selection.channel_of(event_of(c, {})));
  CHECK(ReplaySelection({.as_recorded = true}).channel_of(event_of("DEGRADATION", {})));
  CHECK(ReplaySelection({.verbatim = true}).channel_of(event_of("NODE_HEALTH", {})));
  CHECK(ReplaySelection({.also = "THERMAL_.*"}).channel_of(event_of("THERMAL_STATE", {})));
}

TEST_CASE("Messages of a node are not replayed while that node is live") {
  tool_state_t m{};
  m.header = header_of("haptic_node", 3, 1, 1000, 77);
  const auto bytes = encode(m);
  CHECK(ReplaySelection({}).channel_of(event_of("TOOL_STATE", bytes)));
  CHECK(ReplaySelection({.live = {"audio_node"}}).channel_of(event_of("TOOL_STATE", bytes)));
  CHECK_FALSE(ReplaySelection({.live = {"audio_node", "haptic_node"}}).channel_of(event_of("TOOL_STATE", bytes)));
}

TEST_CASE("Channels are selected by regular expressions and renamed") {
  ReplaySelection selection({.channels = "CONTACT.*|MY_OWN", .leave_out = "CONTACTS", .rename = {"MY_OWN=YOURS"}});
  CHECK(selection.channel_of(event_of("CONTACT_EVENTS", {})));
  CHECK_FALSE(selection.channel_of(event_of("CONTACTS", {})));
  CHECK_FALSE(selection.channel_of(event_of("WORLD_STATE", {})));
  CHECK(selection.channel_of(event_of("MY_OWN", {})) == std::string_view("YOURS"));
  CHECK_THROWS_WITH(ReplaySelection({.channels = "(("}), Catch::Contains("regular expression"));
  CHECK_THROWS_WITH(ReplaySelection({.rename = {"A"}}), Catch::Contains("FROM=TO"));
  CHECK_THROWS_WITH(ReplaySelection({.rename = {"A=" + std::string(64, 'x')}}), Catch::Contains("FROM=TO"));
}

TEST_CASE("Commands control a replay, and an invalid command is reported") {
  Player p;
  bool quit = false;
  const auto execute = [&](const char* line) { return execute_command(p.replay, line, p.now, quit); };
  CHECK(execute("pause").empty());
  CHECK(p.replay.paused());
  CHECK(execute("  seek   0.5 ").empty());
  CHECK(p.replay.position_s() == Approx(0.5));
  CHECK(execute("seek -0.2").empty());
  CHECK(p.replay.position_s() == Approx(0.3));
  CHECK(execute("speed 2").empty());
  CHECK(p.replay.speed() == 2);
  CHECK(execute("speed max").empty());
  CHECK(p.replay.speed() == 0);
  CHECK(execute("loop on").empty());
  CHECK(p.replay.loop());
  CHECK(execute("toggle").empty());
  CHECK_FALSE(p.replay.paused());
  CHECK(execute("").empty());
  for (const char* line : {"fly", "speed 0", "speed nan", "speed -1", "seek", "seek x", "seek inf", "step -1",
                           "loop maybe", "pause 3", "seek 1 2", "\x01\x02"})
    CHECK_THAT(execute(line), Catch::StartsWith("cannot execute"));
  CHECK_FALSE(quit);
  execute("quit");
  CHECK(quit);
}

TEST_CASE("Lines are read from a pipe in pieces, and an overlong line is skipped") {
  Lines lines;
  std::string line;
  lines.add("pau");
  CHECK_FALSE(lines.take(line));
  lines.add("se\nseek 3\n");
  REQUIRE(lines.take(line));
  CHECK(line == "pause");
  REQUIRE(lines.take(line));
  CHECK(line == "seek 3");
  lines.add(std::string(100'000, 'x') + "\nquit\n");
  REQUIRE(lines.take(line));
  CHECK(line == "quit");
}
