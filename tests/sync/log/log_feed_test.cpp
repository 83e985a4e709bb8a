// Tests of the timestamps of log events, with wrong stamps.
#include "sync/bus/bus.h"
#include "sync/log/log_feed.h"

#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <tactus/log_info_t.hpp>
#include <tactus/node_health_t.hpp>

#include "tests/sync/support/memory_sink.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

constexpr std::int64_t kBegin_ns = 5'000'000'000, kOffset_ns = 1'700'000'000'000'000'123;

struct Folder {
  Folder() {
    char name[] = "/tmp/tactus_feed_XXXXXX";
    if (mkdtemp(name)) path = name;
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string path;
};

// LOG_INFO, then ten NODE_HEALTH messages, 2.5 ms apart.
std::string log_in(const Folder& folder) {
  const std::string path = folder.path + "/run.lcmlog";
  LogWriter writer(std::make_unique<FileSink>(path));
  const auto write = [&](const char* channel, const auto& m, std::int64_t after_us) {
    writer.write((kBegin_ns + kOffset_ns) / 1000 + after_us, channel, encode(m));
  };
  log_info_t info{};
  info.header = header_of("recorder", 1, 0, kBegin_ns, 77);
  info.header.clock = 4711;
  info.realtime_offset_ns = kOffset_ns;
  write(channels::kLogInfo, info, 0);
  for (int i = 0; i < 10; ++i) {
    node_health_t m{};
    m.header = header_of("some_node", 5, i, kBegin_ns, 77);
    m.node = "some_node";
    write(channels::kNodeHealth, m, 2500 * i);
  }
  writer.flush();
  return path;
}

// The same log with other stamps. later_us: shift of the stamp of the i-th health, us.
std::string misdated_log_in(const Folder& folder, const std::function<std::int64_t(int)>& later_us) {
  const std::string path = log_in(folder);
  std::vector<LogEvent> events;
  const MappedLog file(path);
  LogScanner scanner(file.bytes());
  for (LogEvent event; scanner.next(event);) events.push_back(event);
  LogWriter writer(std::make_unique<FileSink>(folder.path + "/misdated.lcmlog"));
  std::fstream bytes(folder.path + "/misdated.lcmlog", std::ios::in | std::ios::out | std::ios::binary);
  std::streamoff at = 0;
  for (std::size_t k = 0; k < events.size(); ++k) {
    const LogEvent& e = events[k];
    writer.write(e.timestamp_us, e.channel, e.data);
    writer.flush();
    // Big-endian, after the sync word and the event number.
    auto stamp = static_cast<std::uint64_t>(e.timestamp_us + (k > 0 ? later_us(static_cast<int>(k) - 1) : 0));
    std::array<char, 8> raw;
    for (std::size_t b = 8; b-- > 0; stamp >>= 8) raw[b] = static_cast<char>(stamp & 0xff);
    bytes.seekp(at + 12).write(raw.data(), 8);
    at += static_cast<std::streamoff>(kLogEventHeaderBytes + e.channel.size() + e.data.size());
  }
  return folder.path + "/misdated.lcmlog";
}

}  // namespace

TEST_CASE("A log feed delivers each message in the first tick after its arrival") {
  const Folder folder;
  LogFeed feed(log_in(folder), 1000);
  CHECK(feed.run_id() == 77);
  CHECK(feed.bus().memory);
  CHECK(feed.bus().clock == 4711);
  Bus bus(Identity::fresh("listener", feed.run_id()), feed.bus());
  auto& healths = bus.queue<node_health_t>(channels::kNodeHealth, 64);
  int heard = 0;
  for (int tick = 0; !feed.over(Nanoseconds(5'000'000)); ++tick) {
    const HostTime now = feed.next(bus);
    CHECK(now == feed.begin() + tick * Nanoseconds(1'000'000));
    while (const auto m = healths.pop()) {
      CHECK(m->arrival == now);  // as a node reads the bus
      ++heard;
    }
    REQUIRE(tick < 100);
  }
  CHECK(heard == 10);
  CHECK(feed.events() == 11);
  CHECK(feed.end() - feed.begin() == Nanoseconds(22'500'000));
}

TEST_CASE("Wrong time stamps do not lengthen a run and lose no messages") {
  constexpr std::int64_t kTenYears_us = 315'000'000'000'000;
  const auto check = [](const std::function<std::int64_t(int)>& later_us, std::int64_t misdated, int last_ns) {
    const Folder folder;
    LogFeed feed(misdated_log_in(folder, later_us), 1000);
    CHECK(feed.misdated() == misdated);
    CHECK(feed.end() - feed.begin() == Nanoseconds(last_ns));
    Bus bus(Identity::fresh("listener", feed.run_id()), feed.bus());
    auto& healths = bus.queue<node_health_t>(channels::kNodeHealth, 64);
    int heard = 0;
    for (int tick = 0; tick < 100 && !feed.over(Nanoseconds(5'000'000)); ++tick) {
      feed.next(bus);
      while (healths.pop()) ++heard;
    }
    CHECK(feed.over(Nanoseconds(5'000'000)));
    CHECK(heard == 10);
  };
  // The last two confirm each other; they are delivered with the eighth.
  check([](int i) { return i >= 8 ? kTenYears_us + i : 0; }, 2, 17'500'000);
  // Two wrong stamps in the middle, equally far back, and stamps out of range.
  check([](int i) { return i == 4 || i == 5 ? kTenYears_us : 0; }, 2, 22'500'000);
  check([](int i) { return i >= 8 ? -kTenYears_us : 0; }, 2, 17'500'000);
  check([](int i) { return i >= 8 ? std::int64_t{3} << 60 : 0; }, 2, 17'500'000);
}

TEST_CASE("A loop with uneven ticks receives all messages that arrived by each tick, in order of time") {
  const Folder folder;
  LogFeed feed(log_in(folder), 1000);
  Bus bus(Identity::fresh("listener", feed.run_id()), feed.bus());
  auto& heard = bus.queue<node_health_t>(channels::kNodeHealth, 64);
  const auto waiting = [&] {
    int n = 0;
    while (heard.pop()) ++n;
    return n;
  };
  const HostTime begin = feed.begin();
  CHECK(feed.next_at(bus, begin + Nanoseconds(2'400'000)) == begin + Nanoseconds(2'400'000));
  CHECK(waiting() == 1);
  CHECK(feed.next_at(bus, begin + Nanoseconds(10'000'000)) == begin + Nanoseconds(10'000'000));
  CHECK(waiting() == 4);
  CHECK(feed.next_at(bus, begin) == begin + Nanoseconds(10'000'000));
  CHECK(waiting() == 0);
  CHECK(feed.next(bus) == begin + Nanoseconds(11'000'000));
  CHECK(feed.next_at(bus, feed.end()) == feed.end());
  CHECK(waiting() == 5);
  CHECK(feed.over(Nanoseconds(0)));
}
