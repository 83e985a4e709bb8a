// Tests of a run that is recorded in several parts.
#include <nlohmann/json.hpp>
#include <tactus/tool_state_t.hpp>

#include "lcmtypes/channels.h"
#include "sync/log/log_parts.h"
#include "tests/cluster/support/run_log.h"
#include "tests/cluster/support/run_script.h"

using namespace tactus;
using namespace tactus::cluster;
using nlohmann::json;

namespace {

std::size_t lines_of(const std::filesystem::path& path) {
  const std::string text = contents(path);
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_CASE("A run recorded in parts has the results of all parts, and can be rendered from its folder or from one part") {
  RunScript run;
  run.start(
      {tapping_scene(), "--seconds", "6", "--without", "visual_node", "--split-mb", "2", "--out", run.out()});
  const int status = run.finish(150);
  INFO(run.processes.output("run"));
  REQUIRE(status == 0);
  const std::vector<std::string> parts = sync::log_parts_in(run.out());
  REQUIRE(parts.size() >= 3);

  // The results of the run cover all parts: every tick of the hand is present, once.
  std::set<std::int64_t> ticks;
  std::size_t tick_count = 0;
  for (const std::string& part : parts) {
    const sync::MappedLog log(part);
    sync::LogScanner scanner(log.bytes());
    bool first = true;
    for (sync::LogEvent e; scanner.next(e); first = false) {
      if (first) CHECK(e.channel == channels::kLogInfo);
      if (e.channel != channels::kToolState) continue;
      const auto m = sync::decode<tool_state_t>(e.data.data(), e.data.size());
      REQUIRE(m);
      ticks.insert(m->header.seq);
      ++tick_count;
    }
    CHECK(scanner.damaged_regions() == 0);
  }
  CHECK(ticks.size() == tick_count);
  CHECK(static_cast<std::size_t>(*ticks.rbegin() - *ticks.begin()) + 1 == tick_count);
  CHECK(lines_of(run.out() / "haptic.csv") == tick_count + 1);

  const auto rendered_ticks = [&](const std::filesystem::path& log, const std::string& name) {
    const auto trace = run.folder.path() / name;
    run.output_of({(programs() / "haptic_node").string(), "--log", log, "--trace", trace});
    return lines_of(trace) - 1;
  };
  CHECK(rendered_ticks(run.out(), "all.csv") >= tick_count - 50);  // touch states before the first world state have no result
  const std::size_t second = rendered_ticks(parts[1], "second.csv");
  CHECK(second > 100);
  CHECK(second < tick_count / 2);

  // Replays the parts as one, from an instant in the last part.
  const json description =
      json::parse(run.output_of({(programs() / "replay").string(), run.out(), "--describe"}), nullptr, false);
  REQUIRE_FALSE(description.is_discarded());
  CHECK(description["length_s"] > 5);
}

TEST_CASE("A run that keeps its newest parts has their results, and the older parts are deleted") {
  RunScript run;
  run.start({tapping_scene(), "--seconds", "6", "--without", "visual_node", "--split-mb", "1", "--keep", "2",
             "--tags", "none", "--out", run.out()});
  const int status = run.finish(150);
  INFO(run.processes.output("run"));
  CHECK(status == 0);
  const std::vector<std::string> parts = sync::log_parts_in(run.out());
  CHECK(parts.size() == 2);
  CHECK_FALSE(std::filesystem::exists(run.out() / "run.lcmlog"));
  const std::size_t ticks = lines_of(run.out() / "haptic.csv");
  CHECK(ticks > 100);
  CHECK(ticks < 5000);
  CHECK_FALSE(json::parse(contents(run.out() / "summary.json"), nullptr, false).is_discarded());
}
