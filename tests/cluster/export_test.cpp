// Tests of the tables exported from the log of a real run.
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "sync/text/csv.h"
#include "tests/cluster/support/run_script.h"

using namespace tactus::cluster;
using nlohmann::json;

namespace {

struct Rows {
  std::vector<std::string> names;
  std::vector<std::map<std::string, std::string>> rows;
};
Rows read_rows(const std::filesystem::path& path) {
  Rows out;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  out.names = tactus::sync::csv_cells(line);
  while (std::getline(file, line)) {
    const auto cells = tactus::sync::csv_cells(line);
    REQUIRE(cells.size() == out.names.size());
    auto& row = out.rows.emplace_back();
    for (std::size_t i = 0; i < cells.size(); ++i) row[out.names[i]] = cells[i];
  }
  return out;
}

}  // namespace

TEST_CASE("The tables exported from the log of a run agree with its summary") {
  RunScript run;
  run.start({(repository() / "sim_node/scenes/steel_then_oak.sdf").string(), "--seconds", "4", "--without",
             "visual_node", "--out", run.out()});
  REQUIRE(run.finish(120) == 0);
  const auto tables = run.out("tables");
  run.output_of({"env", "TACTUS_BIN=" + programs().string(), (repository() / "scripts/tactus").string(), "export", run.out(),
                 "--out", tables});
  const json schema = json::parse(contents(tables / "schema.json"), nullptr, false);
  REQUIRE_FALSE(schema.is_discarded());
  CHECK(schema["damaged_regions"] == 0);
  CHECK(schema["broken_messages"] == 0);
  CHECK(schema["foreign_messages"] == 0);

  // The table of TOOL_STATE that the run itself wrote, message by message.
  const Rows own = read_rows(run.out() / "haptic.csv");
  const Rows tool = read_rows(tables / "TOOL_STATE.csv");
  CHECK(schema["files"]["TOOL_STATE.csv"]["messages"] == own.rows.size());
  std::vector<double> z;
  for (const auto& row : tool.rows)
    if (row.at("field") == "force_N.z") {
      z.push_back(std::stod(row.at("value")));
      CHECK(row.at("unit") == "N");
      CHECK(row.at("sender") == "haptic_node");
    }
  REQUIRE(z.size() == own.rows.size());
  for (std::size_t i = 0; i < z.size(); ++i)
    REQUIRE(z[i] == Approx(std::stod(own.rows[i].at("force_z_N"))).margin(1e-3));

  run.output_of({"env", "TACTUS_BIN=" + programs().string(), (repository() / "scripts/tactus").string(), "export", run.out(),
                 "--out", tables, "--wide", "--channels", "TOOL_STATE", "--since", "1", "--until", "2"});
  const Rows wide = read_rows(tables / "TOOL_STATE.csv");
  REQUIRE_FALSE(wide.rows.empty());
  CHECK(wide.rows.size() < own.rows.size());
  for (const auto& row : wide.rows) {
    CHECK(std::stod(row.at("log_s")) >= 1);
    CHECK(std::stod(row.at("log_s")) <= 2);
    CHECK(row.contains("force_N.z (N)"));
  }
}
