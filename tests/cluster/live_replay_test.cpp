// Tests of a recorded run replayed on the bus to live renderers, with its control pipe and with LCM's stock tools.
#include <signal.h>
#include <sys/stat.h>

#include <fstream>
#include <tactus/world_state_t.hpp>

#include "sync/log/log_reader.h"
#include "sync/log/log_writer.h"
#include "sync/log/mapped_log.h"
#include "tests/cluster/support/run_log.h"
#include "tests/cluster/support/running.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

constexpr std::int64_t kLiveRun = RunningCluster::kRunId + 1;

// Records four seconds of the small scene into folder/run.lcmlog.
std::filesystem::path record_run(const Folder& folder) {
  RunningCluster c;
  c.processes.start("recorder");
  c.start();
  c.monitor.receive_for(4);
  c.processes.signal("recorder", SIGTERM);
  REQUIRE(c.processes.wait_for_exit("recorder", kTimeout_s) == 0);
  std::filesystem::rename(c.folder.path() / "run.lcmlog", folder.path() / "run.lcmlog");
  return folder.path() / "run.lcmlog";
}

std::vector<std::string> options_of_replay(const std::filesystem::path& log, std::vector<std::string> more = {}) {
  std::vector<std::string> words{log.string()};
  for (const std::string& sense : kModalityNodes) words.insert(words.end(), {"--live", sense});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// Events of a log, without LCM's network self-tests.
std::vector<std::pair<std::string, std::vector<std::uint8_t>>> events_in(const std::filesystem::path& path) {
  sync::MappedLog file(path);
  sync::LogScanner scanner(file.bytes());
  std::vector<std::pair<std::string, std::vector<std::uint8_t>>> out;
  for (sync::LogEvent e; scanner.next(e);)
    if (e.channel != "LCM_SELF_TEST" && e.channel != channels::kNodeHealth)
      out.emplace_back(e.channel, std::vector<std::uint8_t>(e.data.begin(), e.data.end()));
  return out;
}

}  // namespace

TEST_CASE("All modalities render a replayed log, and continue when one of them is killed") {
  Folder folder;
  const auto log = record_run(folder);
  Processes processes(folder.path() / "again", kLiveRun);
  ClusterMonitor monitor(kLiveRun);
  for (const std::string& sense : kModalityNodes) processes.start(sense);
  processes.start("replay", options_of_replay(log, {"--loop"}));
  const auto all_have_rendered = [&](const std::string& except, const std::map<std::string, std::int64_t>& before) {
    return std::all_of(kModalityNodes.begin(), kModalityNodes.end(), [&](const std::string& n) {
      return n == except || monitor.rendered(n) > (before.contains(n) ? before.at(n) : 0);
    });
  };
  const bool rendered = monitor.wait_until([&] { return all_have_rendered("", {}); }, kTimeout_s);
  for (const std::string& n : kModalityNodes) INFO(n << " rendered " << monitor.rendered(n) << ": " << processes.output(n));
  INFO(processes.output("replay"));
  REQUIRE(rendered);
  // The recorded health of renderers is not replayed: one haptic_node publishes, with one incarnation.
  CHECK(monitor.rejoined("haptic_node") == 0);
  CHECK(monitor.wait_until([&] { return monitor.health("sim_node") == nullptr; }, kTimeout_s));

  processes.kill("audio_node");
  std::map<std::string, std::int64_t> before;
  for (const std::string& n : kModalityNodes) before[n] = monitor.rendered(n);
  CHECK(monitor.wait_until([&] { return all_have_rendered("audio_node", before); }, kTimeout_s));
  SECTION("a restarted node receives the scene and renders") {
    processes.start("audio_node");
    const std::int64_t old = monitor.rendered("audio_node");
    CHECK(monitor.wait_until(
        [&] {
          return monitor.rejoined("audio_node") > 0 && monitor.rendered("audio_node") != old &&
                 monitor.rendered("audio_node") > 0;
        },
        kTimeout_s));
  }
  for (const char* n : {"haptic_node", "visual_node", "thermal_node"}) CHECK(processes.running(n));
}

TEST_CASE("A running replay executes the commands from its pipe") {
  Folder folder;
  const auto log = record_run(folder);
  const std::string pipe = folder.path() / "control";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  Processes processes(folder.path() / "again", kLiveRun);
  ClusterMonitor monitor(kLiveRun);
  auto& states = monitor.bus().queue<world_state_t>(channels::kWorldState, 4096);
  processes.start("replay", {log, "--paused", "--stay", "--control", pipe});
  const auto command = [&](const std::string& words) { std::ofstream(pipe) << words << std::endl; };
  // Instants of the world that are published within the given time.
  const auto received_times = [&](double seconds) {
    monitor.receive_for(0.3);
    while (states.pop()) {
    }
    monitor.receive_for(seconds);
    std::vector<std::int64_t> times;
    while (const auto m = states.pop()) times.push_back(m->message.header.sim_time_ns);
    return times;
  };
  // A busy machine executes a command late.
  const auto eventually_plays = [&](bool wanted) {
    for (double waited_s = 0; waited_s < kTimeout_s; waited_s += 0.8)
      if (!received_times(0.5).empty() == wanted) return true;
    return false;
  };
  REQUIRE(monitor.wait_until([&] { return monitor.health("replay") != nullptr; }, kTimeout_s));
  CHECK(received_times(0.5).empty());
  command("loop on\nresume");
  CHECK(eventually_plays(true));
  command("pause");
  CHECK(eventually_plays(false));
  command("seek 1\nstep 0.5");
  CHECK(monitor.wait_until([&] { return processes.output("replay").find("1.00 of") != std::string::npos; }, kTimeout_s));
  CHECK(eventually_plays(false));
  command("fly");
  CHECK(monitor.wait_until([&] { return processes.output("replay").find("cannot execute 'fly'") != std::string::npos; },
                       kTimeout_s));
  command("quit");
  CHECK(processes.wait_for_exit("replay", kTimeout_s) == 0);
}

TEST_CASE("The stock lcm-logger receives all replayed messages unchanged, and its log can be replayed") {
  Folder folder;
  const std::filesystem::path own_log = folder.path() / "ours.lcmlog";
  {
    sync::LogWriter writer(std::make_unique<sync::FileSink>(own_log));
    for (int i = 0; i < 1000; ++i)
      writer.write(1'700'000'000'000'000 + 1000 * i, "CHANNEL_" + std::to_string(i % 5),
                   std::vector<std::uint8_t>(static_cast<std::size_t>(i % 700), static_cast<std::uint8_t>(i)));
    writer.flush();
  }
  Processes processes(folder.path() / "out", kLiveRun);
  const auto through_lcm_logger = [&](const std::filesystem::path& from, const std::filesystem::path& to,
                                      const std::vector<std::string>& options) {
    processes.spawn("lcm-logger", {"lcm-logger", "--quiet", "--lcm-url=udpm://239.255.76.67:7667?ttl=0", to});
    ClusterMonitor monitor(kLiveRun);
    monitor.wait_until([&] { return std::filesystem::exists(to); }, kTimeout_s);
    monitor.receive_for(0.5);
    // No faster than the stock logger can follow on a busy machine: its receive buffer of 208 KiB holds 0.6 s of this.
    std::vector<std::string> words{from, "--most", "250"};
    words.insert(words.end(), options.begin(), options.end());
    processes.start("replay", words);
    REQUIRE(processes.wait_for_exit("replay", kTimeout_s) == 0);
    monitor.receive_for(1);
    processes.signal("lcm-logger", SIGTERM);
    processes.wait_for_exit("lcm-logger", kTimeout_s);
  };
  through_lcm_logger(own_log, folder.path() / "stock.lcmlog", {});
  CHECK_THAT(processes.output("replay"), Catch::Contains("holds no message of Tactus"));
  const bool all_received = events_in(own_log) == events_in(folder.path() / "stock.lcmlog");
  CHECK(all_received);
  // The replay's own messages are recorded, too, and are no longer foreign.
  through_lcm_logger(folder.path() / "stock.lcmlog", folder.path() / "again.lcmlog", {"--verbatim"});
  const bool identical = events_in(folder.path() / "stock.lcmlog") == events_in(folder.path() / "again.lcmlog");
  CHECK(identical);
}
