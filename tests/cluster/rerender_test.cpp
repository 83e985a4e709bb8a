// Tests of a recorded run rendered again by every modality: identical each time, and equal to the run itself.
#include <nlohmann/json.hpp>

#include "tests/cluster/support/run_script.h"

using namespace tactus::cluster;
using nlohmann::json;

namespace {

json row_of(const json& rows, const std::string& sense, const std::string& what) {
  for (const json& row : rows)
    if (row["sense"] == sense && row["what"].get<std::string>().starts_with(what)) return row;
  FAIL("no row on " << sense << ", " << what);
  return {};
}

json changed_of(const json& result, const std::string& sense) {
  for (const json& row : result["changed"])
    if (row["sense"] == sense) return row;
  FAIL("no row on the change of " << sense);
  return {};
}

}  // namespace

TEST_CASE(
    "A recorded run renders twice to the same bytes, within 1 ms of its live sound, and a profile "
    "changes only its modality") {
  RunScript run;
  run.start({tapping_scene(), "--seconds", "5", "--out", run.out()});
  const int status = run.finish(150);
  INFO(run.processes.output("run"));
  REQUIRE(status == 0);
  const std::filesystem::path late = run.folder.path() / "late.xml", table = run.folder.path() / "table.json";
  std::ofstream(late) << R"(<profile name="late"><degrade modality="audio" delay="40ms"/></profile>)";
  // Exits with 1 when a byte differs, or when an onset of sound is more than 1 ms off.
  const std::string output = run.output_of(
      {"env", "TACTUS_BIN=" + programs().string(), (repository() / "scripts/tactus").string(), "rerender", run.out() / "run.lcmlog", "--degrade", late,
       "--twice", "--live", "--set", "visual:width=320", "--set", "visual:height=240", "--json", table});
  INFO(output);
  const json result = json::parse(contents(table));
  CHECK(result["not_rendered"].empty());
  REQUIRE(result["twice"].size() == 4);
  for (const json& row : result["twice"]) {
    INFO(row);
    CHECK(row["differ"].empty());
    CHECK(row["bytes"] > 1000);
  }

  const json onsets = row_of(result["live"], "audio", "onsets");
  CHECK(onsets["n"] >= 3);
  CHECK(onsets["max"] <= 1.0);
  const json force = row_of(result["live"], "haptic", "force, while");
  CHECK(force["n"] > 100);
  CHECK(force["p50"] < 0.05);
  CHECK(row_of(result["live"], "thermal", "skin")["p50"] < 0.1);

  const json audio = changed_of(result, "audio");
  CHECK(audio["presented"] >= 3);
  CHECK(audio["dropped"] == 0);
  CHECK(std::abs(audio["shift_p50_ms"].get<double>() - 40) < 0.05);        // rounded to a sample, twice
  CHECK(std::abs(audio["heard_shift_p50_ms"].get<double>() - 40) < 0.2);   // onset measured in the samples
  CHECK(changed_of(result, "haptic")["difference_peak_N"] == 0);
  CHECK(changed_of(result, "visual")["frames_differ"] == 0);
  CHECK(changed_of(result, "thermal")["skin_peak_K"] == 0);
}
