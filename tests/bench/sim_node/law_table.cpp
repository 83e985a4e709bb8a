// Random worlds without a driving force, and the laws of mechanics that they break, by family.
//
//    bin/law_table [--count N] [--seed S] [--family NAME]... [--scene FILE.sdf]... [--json FILE] [--set NAME=VALUE]...
//
// The first comment of a scene file may give its duration (seconds 0.5) and its expectation (expect static, rest or
// momentum).
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "sync/node/node_options.h"
#include "sync/text/settings.h"
#include "tests/sim_node/support/mechanics_laws.h"
#include "tests/sim_node/support/world_files.h"

using namespace tactus;
using namespace tactus::sim;

namespace {

void print_report(const std::string& name, const test::LawReport& r, const std::array<bool, test::kLaws>& broken) {
  std::printf("%-28s over %9.3g rise %9.3g scale %9.3g J  overlap %5.1f um  p %7.1g L %7.1g  creep %7.1g tremble %7.1g m/s  held %d missed %d at %.3f, first %.3f, unconverged %d limited %d ",
              name.c_str(), r.over_J, r.rise_J, r.scale_J, 1e6 * r.overlap_m, r.momentum, r.spin_momentum, r.creep_m_s,
              r.tremble_m_s, r.held, r.missed, r.first_missed_s, r.first_over_s, r.unconverged, r.limited);
  for (std::size_t i = 0; i < broken.size(); ++i)
    if (broken[i]) std::printf(" %s", test::kLawNames[i]);
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app("Prints the laws of mechanics that random worlds break, by family");
  int count = 20, seed = 1;
  bool verbose = false;
  std::string json_file;
  std::vector<std::string> families, scenes, overrides;
  app.add_option("--count", count, "Worlds of each family").range(1, 1'000'000);
  app.add_option("--seed", seed, "Seed of the first world; the next ones count on");
  app.add_option("--family", families, "Only this family");
  app.add_option("--scene", scenes, "A scene file in place of random worlds");
  app.add_option("--set", overrides, "A setting of sim_node, as NAME=VALUE");
  app.add_option("--json", json_file, "Writes the counts to this file");
  app.add_flag("--verbose", verbose, "Prints every world that breaks a law");
  sync::parse_or_exit(app, "law_table", argc, argv);
  Settings settings;
  const auto errors = sync::apply_settings(settings, setting_fields(), "sim_node", std::vector<setting_t>{}, overrides);
  if (!errors.empty()) throw std::runtime_error(errors.front());
  for (const std::string& file : scenes) {
    const test::RandomWorld w = test::world_of_file(file);
    const test::LawReport r = test::LawChecker(w, settings).run();
    print_report(std::filesystem::path(file).stem().string(), r, test::broken_laws(w, r));
  }
  if (!scenes.empty()) return 0;
  if (families.empty()) families = test::world_families();
  nlohmann::json out;
  std::printf("%-14s %7s %7s", "family", "worlds", "broken");
  for (const char* name : test::kLawNames) std::printf(" %8s", name);
  std::printf("\n");
  std::array<int, test::kLaws + 2> total{};
  for (const std::string& family : families) {
    std::array<int, test::kLaws> by_law{};
    int broken = 0;
    for (int i = 0; i < count; ++i) {
      const test::RandomWorld w = test::random_world(family, static_cast<std::uint64_t>(seed + i));
      const test::LawReport r = test::LawChecker(w, settings).run();
      const auto laws = test::broken_laws(w, r);
      broken += std::any_of(laws.begin(), laws.end(), [](bool b) { return b; });
      for (std::size_t k = 0; k < laws.size(); ++k) by_law[k] += laws[k];
      if (verbose && std::any_of(laws.begin(), laws.end(), [](bool b) { return b; }))
        print_report(family + " " + std::to_string(seed + i), r, laws);
    }
    std::printf("%-14s %7d %7d", family.c_str(), count, broken);
    total[0] += count, total[1] += broken;
    out[family] = {{"worlds", count}, {"broken", broken}};
    for (std::size_t k = 0; k < by_law.size(); ++k) {
      std::printf(" %8d", by_law[k]);
      out[family][test::kLawNames[k]] = by_law[k];
      total[k + 2] += by_law[k];
    }
    std::printf("\n");
    std::fflush(stdout);
  }
  std::printf("%-14s", "all");
  for (std::size_t i = 0; i < total.size(); ++i) std::printf(i < 2 ? " %7d" : " %8d", total[i]);
  std::printf("\n");
  if (!json_file.empty()) std::ofstream(json_file) << out.dump(1) << "\n";
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "law_table: %s\n", e.what());
  return 1;
}
