// Tests of a report on a real run.
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/cluster/support/run_script.h"

using namespace tactus::cluster;
using nlohmann::json;

TEST_CASE("The report of a run and a degraded run has the same bytes twice, and the figures of the runs") {
  RunScript run;
  const auto late = run.folder.path() / "late.xml";
  std::ofstream(late) << R"(<profile name="late"><degrade modality="audio" delay="60ms"/></profile>)";
  for (const std::string name : {"clean", "late"}) {
    std::vector<std::string> words{tapping_scene(), "--seconds", "5",          "--without",
                                   "visual_node",   "--out",     run.out(name)};
    if (name == "late") words.insert(words.end(), {"--degrade", late});
    run.start(words, name);
    REQUIRE(run.finish(150, name) == 0);
  }
  const auto page = run.folder.path() / "page.html", table = run.folder.path() / "table.json";
  const std::vector<std::string> words{"env",
                                       "TACTUS_BIN=" + programs().string(),
                                       (repository() / "scripts/tactus").string(), "report",
                                       run.out("clean"),
                                       run.out("late"),
                                       "--out",
                                       page,
                                       "--json",
                                       table};
  run.output_of(words);
  const std::string first = contents(page);
  run.output_of(words);
  CHECK((contents(page) == first));

  for (const char* section : {"Comparison", "The run", "Contacts and outcomes", "Rates, ticks",
                              "Latency", "Asynchrony of onsets", "Events", "Force, position, temperature",
                              "Degradation", "Missing data", "Sources"})
    CHECK_THAT(first, Catch::Contains(section));
  CHECK_THAT(first, Catch::Contains("delay=&quot;60ms&quot;"));
  CHECK_THAT(first, Catch::Contains("modality visual was absent"));
  const std::regex outside("(src|href)=\"(?!#|data:)");
  CHECK_FALSE(std::regex_search(first, outside));

  // The data of the page agree with the summaries of the runs.
  const json made = json::parse(contents(table), nullptr, false);
  REQUIRE_FALSE(made.is_discarded());
  CHECK(made["figures"] >= 6);
  for (std::size_t i = 0; i < 2; ++i) {
    const json own = json::parse(contents(run.out(i == 0 ? "clean" : "late") / "summary.json"), nullptr, false);
    CHECK(made["logs"][i]["contacts"] == own["contacts"]);
    for (const auto& [pair, figures] : own["asynchrony_ms"].items()) {
      INFO(pair);
      if (figures["n"] == 0) continue;
      REQUIRE(made["logs"][i]["asynchrony_ms"].contains(pair));
      CHECK(made["logs"][i]["asynchrony_ms"][pair]["n"] == figures["n"]);
      CHECK(std::abs(made["logs"][i]["asynchrony_ms"][pair]["p50"].get<double>() - figures["p50"].get<double>()) <
            3);
    }
  }
  CHECK(std::filesystem::exists(run.folder.path() / "page_figures" / "latency.svg"));
  CHECK(std::filesystem::exists(run.folder.path() / "page_figures" / "asynchrony.png"));
}
