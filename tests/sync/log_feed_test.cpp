#include "sync/log_feed.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>

#include "tests/sync/memory_sink.h"

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

// Says which run it is, then ten healths, 2.5 ms apart.
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

}  // namespace

TEST_CASE("A log is handed over tick by tick, each message in the tick by which it had arrived") {
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
      CHECK(m->arrival <= now);
      CHECK(m->arrival > now - Nanoseconds(1'000'000));
      ++heard;
    }
    REQUIRE(tick < 100);
  }
  CHECK(heard == 10);
  CHECK(feed.events() == 11);
  CHECK(feed.end() - feed.begin() == Nanoseconds(22'500'000));
}
