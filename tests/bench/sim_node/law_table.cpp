// Random worlds without a driving force, and the laws of mechanics that they break, by family and engine.
//
//    bin/law_table [--count N] [--seed S] [--family NAME]... [--engine NAME]... [--scene FILE.sdf]... [--json FILE] [--set NAME=VALUE]...
//
// The first comment of a scene file may give its duration (seconds 0.5) and its expectation (expect static, rest or
// momentum).
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "sync/node/node_options.h"
#include "sync/text/settings.h"
#include "tests/bench/sim_node/law_engines.h"
#include "tests/sim_node/support/world_files.h"

using namespace tactus;
using namespace tactus::sim;

namespace {

struct Options {
  int count = 20, seed = 1;
  bool verbose = false, repeat = false;
  std::string json_file;
  std::vector<std::string> families, engines, scenes, overrides;
};

struct Counts {
  int worlds = 0, broken = 0;
  std::array<int, test::kLaws> by_law{};
  void add(const std::array<bool, test::kLaws>& laws) {
    ++worlds;
    broken += std::any_of(laws.begin(), laws.end(), [](bool b) { return b; });
    for (std::size_t k = 0; k < laws.size(); ++k) by_law[k] += laws[k];
  }
  void add(const Counts& o) {
    worlds += o.worlds, broken += o.broken;
    for (std::size_t k = 0; k < by_law.size(); ++k) by_law[k] += o.by_law[k];
  }
};

bool is_known(const bench::LawEngine& engine, std::size_t law) { return engine.reports_contacts || (law != test::kHeld && law != test::kEvents); }

void print_report(const std::string& name, const test::LawReport& r, const std::array<bool, test::kLaws>& broken) {
  std::printf("%-28s over %9.3g rise %9.3g scale %9.3g J  overlap %5.1f um  p %7.1g L %7.1g  creep %7.1g tremble %7.1g m/s  held %d missed %d at %.3f, first %.3f, unconverged %d limited %d ",
              name.c_str(), r.over_J, r.rise_J, r.scale_J, 1e6 * r.overlap_m, r.momentum, r.spin_momentum, r.creep_m_s,
              r.tremble_m_s, r.held, r.missed, r.first_missed_s, r.first_over_s, r.unconverged, r.limited);
  for (std::size_t i = 0; i < broken.size(); ++i)
    if (broken[i]) std::printf(" %s", test::kLawNames[i]);
  std::printf("\n");
  std::fflush(stdout);
}

void print_row(const std::string& family, const bench::LawEngine& engine, const Counts& c) {
  std::printf("%-14s %-8s %7d %7d", family.c_str(), engine.name.c_str(), c.worlds, c.broken);
  for (std::size_t k = 0; k < c.by_law.size(); ++k)
    is_known(engine, k) ? void(std::printf(" %8d", c.by_law[k])) : void(std::printf(" %8s", "-"));
  std::printf("\n");
  std::fflush(stdout);
}

nlohmann::json to_json(const bench::LawEngine& engine, const Counts& c) {
  nlohmann::json out{{"worlds", c.worlds}, {"broken", c.broken}};
  for (std::size_t k = 0; k < c.by_law.size(); ++k) out[test::kLawNames[k]] = is_known(engine, k) ? nlohmann::json(c.by_law[k]) : nlohmann::json();
  return out;
}

void check_scenes(const Options& o, const std::vector<bench::LawEngine>& engines) {
  for (const std::string& file : o.scenes)
    for (const bench::LawEngine& engine : engines) {
      const test::RandomWorld w = test::world_of_file(file);
      const test::LawReport r = engine.check(w);
      const std::string name = std::filesystem::path(file).stem().string();
      print_report(engines.size() > 1 ? name + " " + engine.name : name, r, test::broken_laws(w, r));
    }
}

void print_unheld(const std::vector<std::string>& worlds, std::size_t engines) {
  if (engines < 2) return;
  std::printf("worlds in which each of these engines breaks a law: %zu\n", worlds.size());
  std::string line;
  for (const std::string& world : worlds) line += (line.empty() ? "  " : ", ") + world;
  if (!line.empty()) std::printf("%s\n", line.c_str());
}

void check_families(const Options& o, const std::vector<bench::LawEngine>& engines) {
  nlohmann::json out;
  std::map<std::string, Counts> total;
  std::vector<std::string> unheld;
  std::printf("%-14s %-8s %7s %7s", "family", "engine", "worlds", "broken");
  for (const char* name : test::kLawNames) std::printf(" %8s", name);
  std::printf("\n");
  for (const std::string& family : o.families) {
    std::map<std::string, Counts> counts;
    for (int seed = o.seed; seed < o.seed + o.count; ++seed) {
      const test::RandomWorld w = test::random_world(family, static_cast<std::uint64_t>(seed));
      const std::string name = family + " " + std::to_string(seed);
      bool held = false;
      for (const bench::LawEngine& engine : engines) {
        const test::LawReport r = engine.check(w);
        const auto laws = test::broken_laws(w, r);
        counts[engine.name].add(laws);
        const bool broken = std::any_of(laws.begin(), laws.end(), [](bool b) { return b; });
        held |= !broken;
        if (o.verbose && broken) print_report(name + " " + engine.name, r, laws);
      }
      if (!held) unheld.push_back(name);
    }
    for (const bench::LawEngine& engine : engines) {
      print_row(family, engine, counts[engine.name]);
      out["families"][family][engine.name] = to_json(engine, counts[engine.name]);
      total[engine.name].add(counts[engine.name]);
    }
  }
  for (const bench::LawEngine& engine : engines) {
    print_row("all", engine, total[engine.name]);
    out["all"][engine.name] = to_json(engine, total[engine.name]);
  }
  print_unheld(unheld, engines.size());
  out["held_by_no_engine"] = unheld;
  if (!o.json_file.empty()) std::ofstream(o.json_file) << out.dump(1) << "\n";
}

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app("Prints the laws of mechanics that random worlds break, by family and engine");
  Options o;
  app.add_option("--count", o.count, "Worlds of each family").range(1, 1'000'000);
  app.add_option("--seed", o.seed, "Seed of the first world; the next ones count on");
  app.add_option("--family", o.families, "Only this family");
  app.add_option("--engine", o.engines, "tactus (the default), ode, ode_step or bullet, beside others in the same run");
  app.add_option("--scene", o.scenes, "A scene file in place of random worlds");
  app.add_option("--set", o.overrides, "A setting of sim_node, as NAME=VALUE");
  app.add_option("--json", o.json_file, "Writes the counts to this file");
  app.add_flag("--repeat", o.repeat, "Runs each world twice and compares the states at the end");
  app.add_flag("--verbose", o.verbose, "Prints every world that breaks a law");
  sync::parse_or_exit(app, "law_table", argc, argv);
  Settings settings;
  const auto errors = sync::apply_settings(settings, setting_fields(), "sim_node", std::vector<setting_t>{}, o.overrides);
  if (!errors.empty()) throw std::runtime_error(errors.front());
  if (o.engines.empty()) o.engines = {"tactus"};
  if (o.families.empty()) o.families = test::world_families();
  std::vector<bench::LawEngine> engines;
  for (const std::string& name : o.engines) {
    const auto& known = bench::law_engine_names();
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw std::runtime_error("there is no engine \"" + name + "\"; choose from tactus, ode, ode_step and bullet");
    if (auto engine = bench::law_engine(name, settings, o.repeat))
      engines.push_back(std::move(*engine));
    else
      std::printf("skipped: %s was not installed when this program was built; run scripts/setup peers and build again\n", name.c_str());
  }
  o.scenes.empty() ? check_families(o, engines) : check_scenes(o, engines);
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "law_table: %s\n", e.what());
  return 1;
}
