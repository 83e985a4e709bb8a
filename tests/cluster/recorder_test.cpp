// Tests of the recorder under a kill, a full disk and a flood of messages.
#include <signal.h>
#include <stdlib.h>
#include <sys/mount.h>

#include <fstream>
#include <set>
#include <tactus/game_state_t.hpp>
#include <tactus/node_health_t.hpp>
#include <thread>

#include "sync/log/log_header.h"
#include "sync/log/log_reader.h"
#include "sync/log/mapped_log.h"
#include "sync/clocks/pacing.h"
#include "tests/cluster/support/run_log.h"
#include "tests/cluster/support/running.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

// Sends numbered messages on a channel that no other program uses.
struct Sender {
  static constexpr const char* kChannel = channels::kGameState;
  ClusterMonitor monitor{RunningCluster::kRunId};
  std::vector<sync::HostTime> sent;

  void send(int count, sync::Nanoseconds interval) {
    sync::HostTime next = sync::host_now();
    for (int i = 0; i < count; ++i) {
      game_state_t m{};
      m.header.sim_time_ns = 0;
      monitor.bus().publish(kChannel, m);
      sent.push_back(sync::host_now());
      next += interval;
      std::this_thread::sleep_until(std::chrono::steady_clock::time_point(next.time_since_epoch()));
    }
  }
};

std::vector<std::int64_t> numbers_in(const std::filesystem::path& log) {
  sync::MappedLog file(log);
  sync::LogScanner scanner(file.bytes());
  std::vector<std::int64_t> numbers;
  for (sync::LogEvent e; scanner.next(e);)
    if (e.channel == Sender::kChannel)
      if (const auto header = sync::peek_header(e.data.data(), e.data.size())) numbers.push_back(header->seq);
  // However the recorder ended, the file ends at the end of an event.
  CHECK(scanner.damaged_regions() == 0);
  return numbers;
}

}  // namespace

TEST_CASE("A killed recorder loses at most the last 100 ms, and its file is valid up to that point") {
  Folder folder;
  Processes processes(folder.path(), RunningCluster::kRunId);
  Sender sender;
  processes.start("recorder");
  REQUIRE(sender.monitor.wait_until([&] { return sender.monitor.health("recorder") != nullptr; }, kTimeout_s));
  // Without a scene the log begins after 5 s; earlier messages wait until then.
  sender.send(7000, sync::Nanoseconds(1'000'000));
  const sync::HostTime killed = sync::host_now();
  processes.kill("recorder");
  const auto numbers = numbers_in(folder.path() / "run.lcmlog");
  std::size_t expected = 0;
  while (expected < sender.sent.size() && sender.sent[expected] < killed - sync::Nanoseconds(100'000'000)) ++expected;
  CHECK(numbers.size() >= expected);
  for (std::size_t i = 0; i < numbers.size(); ++i) CHECK(numbers[i] == static_cast<std::int64_t>(i));
}

TEST_CASE("A recorder with a full disk reports it, and its file is valid up to that point") {
  Folder folder;
  const std::filesystem::path small = folder.path() / "small";
  std::filesystem::create_directory(small);
  if (mount("tmpfs", small.c_str(), "tmpfs", 0, "size=400k") != 0) {
    WARN("skipped: this system does not allow mounting a tmpfs");
    return;
  }
  {
    Processes processes(folder.path(), RunningCluster::kRunId);
    Sender sender;
    processes.spawn("recorder", {(programs() / "recorder").string(), "--run-id", std::to_string(RunningCluster::kRunId),
                                 "--out", small});
    REQUIRE(sender.monitor.wait_until([&] { return sender.monitor.health("recorder") != nullptr; }, kTimeout_s));
    sender.send(9000, sync::Nanoseconds(700'000));
    const bool reported = sender.monitor.wait_until(
        [&] {
          const node_health_t* h = sender.monitor.health("recorder");
          return h && h->state == node_health_t::OUTPUT_LOST &&
                 h->status_text.find("No space left on device") != std::string::npos;
        },
        kTimeout_s);
    CHECK(reported);
    const auto numbers = numbers_in(small / "run.lcmlog");
    CHECK(numbers.size() > 100);
    for (std::size_t i = 0; i < numbers.size(); ++i) CHECK(numbers[i] == static_cast<std::int64_t>(i));
    processes.signal("recorder", SIGTERM);
    CHECK(processes.wait_for_exit("recorder", kTimeout_s) == 1);
    CHECK_THAT(processes.output("recorder"), Catch::Contains("free space on its disk"));
  }
  umount(small.c_str());
}

TEST_CASE(
    "The recorder stores all messages that the kernel delivers while a node floods the bus, and those "
    "of the other nodes") {
  Folder folder;
  Processes processes(folder.path(), RunningCluster::kRunId);
  Sender sender;
  processes.start("recorder", {"--split-mb", "1"});
  REQUIRE(sender.monitor.wait_until([&] { return sender.monitor.health("recorder") != nullptr; }, kTimeout_s));
  sender.send(60'000, sync::Nanoseconds(0));
  sender.monitor.receive_for(6);
  processes.signal("recorder", SIGTERM);
  CHECK(processes.wait_for_exit("recorder", kTimeout_s) == 0);
  std::set<std::int64_t> found;
  int parts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    if (entry.path().extension() != ".lcmlog") continue;
    ++parts;
    for (const std::int64_t n : numbers_in(entry.path())) CHECK(found.insert(n).second);
  }
  CHECK(parts > 3);
  CHECK_THAT(processes.output("recorder"), !Catch::Contains("want of"));
  // The missing messages form a gap that the recorder has counted: as many as the kernel dropped at its socket.
  const std::string output = processes.output("recorder");
  const std::size_t at = output.rfind("GAME_STATE ");
  const std::int64_t gaps = at == std::string::npos ? 0 : std::stoll(output.substr(at + 11));
  CHECK(static_cast<std::int64_t>(found.size()) + gaps >= 60'000 - 1);
}
