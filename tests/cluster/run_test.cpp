// Tests of scripts/run as a user calls it.
#include <nlohmann/json.hpp>

#include "tests/cluster/support/run_script.h"

using namespace tactus::cluster;
using nlohmann::json;

namespace {

constexpr double kRunTimeout_s = 150;

double media_seconds(RunScript& run, const std::filesystem::path& file) {
  const std::string text = run.output_of({"ffprobe", "-v", "error", "-show_entries", "format=duration", "-of", "csv=p=0", file});
  return std::atof(text.c_str());
}

void check_keys(const json& object, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    INFO(key << " in " << object.dump().substr(0, 500));
    CHECK(object.contains(key));
  }
}

}  // namespace

TEST_CASE("scripts/run writes the log, sound, pictures, tables and a complete summary", "[smoke]") {
  RunScript run;
  run.start({tapping_scene(), "--seconds", "8", "--out", run.out()});
  const int status = run.finish(kRunTimeout_s);
  INFO(run.processes.output("run"));
  REQUIRE(status == 0);
  CHECK(all_processes_ended(5));
  for (const char* file : {"run.lcmlog", "audio.wav", "video.mp4", "haptic.csv", "thermal.csv", "events.csv", "presented.csv",
                           "summary.json"}) {
    INFO(file);
    REQUIRE(std::filesystem::is_regular_file(run.out() / file));
    CHECK(std::filesystem::file_size(run.out() / file) > 1000);
  }
  CHECK(std::filesystem::is_directory(run.out() / "logs"));
  CHECK_FALSE(std::filesystem::exists(std::filesystem::symlink_status(run.out() / "cluster")));
  CHECK(media_seconds(run, run.out() / "audio.wav") > 4);
  CHECK(media_seconds(run, run.out() / "video.mp4") > 4);

  const json summary = json::parse(contents(run.out() / "summary.json"));
  check_keys(summary, {"scene", "seconds", "recorded_seconds", "seed", "git", "realtime_factor", "warnings", "absent", "nodes", "contacts", "asynchrony_ms",
                       "bus"});
  for (const std::string& node : kNodes) {
    REQUIRE(summary["nodes"].contains(node));
    check_keys(summary["nodes"][node], {"rate_hz", "ticks", "missed_ticks", "stale_ticks", "tick_us", "wake_us", "restarts"});
    check_keys(summary["nodes"][node]["tick_us"], {"p50", "p99", "p999", "max"});
    CHECK(summary["nodes"][node]["restarts"] == 0);
  }
  check_keys(summary["contacts"], {"begin", "hit", "end", "presented", "lost", "stalled", "dropped_by_profile"});
  check_keys(summary["contacts"]["presented"], {"haptic", "audio", "visual", "thermal"});
  check_keys(summary["asynchrony_ms"], {"haptic_audio", "haptic_visual", "audio_visual"});
  check_keys(summary["asynchrony_ms"]["haptic_audio"], {"n", "p05", "p50", "p95"});
  CHECK(summary["contacts"]["hit"] > 0);
  for (const auto& [channel, counts] : summary["bus"].items()) check_keys(counts, {"messages", "bytes", "gaps"});
}

TEST_CASE("With two groups every modality presents its expected events, and the world keeps its rate") {
  RunScript run;
  run.start({"--seconds", "8", "--set", "sim_node.groups=dual", "--out", run.out()});
  const int status = run.finish(kRunTimeout_s);
  INFO(run.processes.output("run"));
  CHECK(status == 0);
  const json summary = json::parse(contents(run.out() / "summary.json"));
  for (const char* sense : {"audio", "haptic", "thermal", "visual"}) {
    INFO(sense);
    CHECK(summary["contacts"]["by_modality"][sense]["presented"].get<int>() > 0);
    CHECK(summary["contacts"]["by_modality"][sense]["lost"].get<int>() == 0);
  }
}

TEST_CASE("Without audio_node the others run unchanged, in the default scene") {
  RunScript run;
  run.start({"--seconds", "6", "--without", "audio_node", "--out", run.out()});
  const int status = run.finish(kRunTimeout_s);
  INFO(run.processes.output("run"));
  CHECK(status == 0);
  CHECK_FALSE(std::filesystem::exists(run.out() / "audio.wav"));
  CHECK(std::filesystem::exists(run.out() / "video.mp4"));
  CHECK(json::parse(contents(run.out() / "summary.json"))["absent"] == json::array({"audio"}));
}

TEST_CASE("A closed output pipe loses no results, and leaves no process behind") {
  RunScript run;
  const std::string script = (repository() / "scripts/run").string();
  run.processes.spawn("pipe", {"env", "TACTUS_BIN=" + programs().string(), "sh", "-c",
                               quoted(script) + " " + quoted(tapping_scene()) + " --seconds 3 --out " + quoted(run.out()) + " | head -1"});
  CHECK(run.finish(kRunTimeout_s, "pipe") == 0);
  INFO(run.processes.output("pipe"));
  for (int i = 0; i < 600 && !std::filesystem::exists(run.out() / "events.csv"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  CHECK(all_processes_ended(15));
  for (const char* file : {"run.lcmlog", "haptic.csv", "thermal.csv", "events.csv", "presented.csv", "summary.json"}) {
    INFO(file);
    CHECK(std::filesystem::is_regular_file(run.out() / file));
  }
}

TEST_CASE("Errors of the command line are reported in one sentence before any process starts", "[smoke]") {
  struct BadCommand {
    std::vector<std::string> options;
    std::string expected_word;
  };
  RunScript run;
  const std::filesystem::path broken = run.folder.path() / "broken.sdf";
  std::ofstream(broken) << "<sdf version='1.9'><world name='w'><model name='m'><link></world></sdf>\n";
  const BadCommand bad = GENERATE_COPY(values<BadCommand>({
      {{"--bogus"}, "--bogus"},
      {{"nowhere.sdf"}, "nowhere.sdf"},
      {{broken.string()}, "sim_node"},
      {{"--seconds", "many"}, "--seconds"},
      {{"--seconds", "-1"}, "--seconds"},
      {{"--without", "nose_node"}, "nose_node"},
      {{"--device", "glove"}, "haptic_node"},
      {{"--device", "playback:nowhere.csv"}, "nowhere.csv"},
      {{"--realtime", "perhaps"}, "--realtime"},
      {{"--set", "audio_node.nothing=1"}, "nothing"},
      {{"--set", "thermal_node.rate=100000"}, "rate"},
      {{"--port", "99999999"}, "--port"},
      {{"--out", "/proc/nowhere/run"}, "/proc/nowhere"},
  }));
  run.start(bad.options);
  CHECK(run.finish(60) == 1);
  const std::string output = run.processes.output("run");
  INFO(output);
  CHECK(output.find(bad.expected_word) != std::string::npos);
  CHECK(std::count(output.begin(), output.end(), '\n') == 1);
  CHECK(all_processes_ended(5));
  CHECK_FALSE(std::filesystem::exists(run.folder.path() / "out"));
}

TEST_CASE("A busy port of the machine's network is named, with the remedy") {
  RunScript run;
  run.start({tapping_scene(), "--seconds", "30", "--network", "host", "--without", "visual_node", "--out", run.out("a")}, "first");
  const auto up = [&] {
    return contents(run.out("a") / "logs/sim_node.log").find("the world begins") != std::string::npos;
  };
  for (int i = 0; i < 600 && !up(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  REQUIRE(up());
  run.start({tapping_scene(), "--seconds", "1", "--network", "host", "--out", run.out("b")}, "second");
  CHECK(run.finish(60, "second") == 1);
  const std::string output = run.processes.output("second");
  INFO(output);
  CHECK(output.find("7667") != std::string::npos);
  CHECK(output.find("--port") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(run.out("b")));
  // Ctrl-C ends the first run early, with its results.
  run.processes.signal("first", SIGINT);
  const int status = run.finish(60, "first");
  INFO(run.processes.output("first"));
  CHECK(status == 0);
  CHECK(std::filesystem::exists(run.out("a") / "summary.json"));
}

TEST_CASE("Two simultaneous runs do not receive each other's messages") {
  RunScript run;
  const std::vector<std::string> names{"a", "b"};
  for (const std::string& name : names)
    run.start({tapping_scene(), "--seconds", "4", "--without", "visual_node", "--out", run.out(name)}, name);
  for (const std::string& name : names) {
    const int status = run.finish(kRunTimeout_s, name);
    INFO(run.processes.output(name));
    CHECK(status == 0);
    const json summary = json::parse(contents(run.out(name) / "summary.json"), nullptr, false);
    REQUIRE_FALSE(summary.is_discarded());
    // Another node of the same name would count as a restart.
    for (const auto& [node, figures] : summary["nodes"].items()) CHECK(figures["restarts"] == 0);
  }
}

TEST_CASE("A killed scripts/run leaves no process behind") {
  const std::string network = GENERATE(as<std::string>{}, "private", "host");
  RunScript run;
  run.start({tapping_scene(), "--seconds", "60", "--network", network, "--out", run.out()});
  const auto up = [&] { return std::filesystem::exists(run.out() / "run.lcmlog"); };
  for (int i = 0; i < 1200 && !up(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  REQUIRE(up());
  CHECK(running_processes().size() > 5);
  run.processes.kill("run");
  CHECK(all_processes_ended(10));
}
