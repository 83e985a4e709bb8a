// Hostile messages on every channel of a whole cluster in virtual time, beside the genuine senders and in their place: damaged
// ones, those of other runs and of second senders, and forged ones with false times, numbers and values.
//
//    bin/hostile_table [--ticks N] [--full] [--seed N] [--only TEXT] [--check] [--json FILE]
//
// Each row is one kind of message on a group of channels, one a millisecond on each. Prints messages, largest force, exposure
// of the skin to warmth and cold, growth of the allocated memory after the first quarter, outputs that differ from those of an
// undisturbed cluster although they must not, and passed limits. --full: 10^6 ticks in all. --check: exit 1 when a row fails.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/bench/cluster/hostile_row.h"

using namespace tactus::bench;

namespace {

constexpr int kFullTicks = 1'000'000;

struct Options {
  int ticks = 4000;
  unsigned seed = 1;
  bool full = false, check = false;
  std::string only, json;
};

std::string changed(const HostileRow& row, const Hashes& clean, const Hashes& hostile) {
  std::string names;
  for (const auto& [output, name] : {std::pair{kWorld, "world"}, std::pair{kTouch, "touch"}, std::pair{kWarmth, "warmth"}, std::pair{kSound, "sound"}})
    if ((row.same & output) != 0 && clean.at(output) != hostile.at(output)) names += (names.empty() ? "" : " ") + std::string(name);
  return names;
}

int run(Options options) {
  std::vector<HostileRow> rows;
  for (HostileRow& row : hostile_rows())
    if (std::string_view(row.name).find(options.only) != std::string_view::npos) rows.push_back(std::move(row));
  if (rows.empty()) throw std::runtime_error("no row has the text of --only in its name; leave --only out to see all names");
  if (options.full) options.ticks = kFullTicks / static_cast<int>(rows.size()) + 1;
  const Hashes clean = run_row({}, options.ticks, options.seed, false).hashes;
  std::printf("%-38s %9s %10s %7s %8s %7s %10s  %s\n", "messages", "ticks", "messages", "force/N", "warmth/s", "cold/s", "growth/kB", "violations");
  nlohmann::json out = nlohmann::json::array();
  int violations = 0;
  for (const HostileRow& row : rows) {
    HostileResult r = run_row(row, options.ticks, options.seed, true);
    if (const std::string names = changed(row, clean, r.hashes); !names.empty()) r.faults += (r.faults.empty() ? "" : "; ") + std::string("changed: ") + names;
    std::printf("%-38s %9lld %10lld %7.2f %8.1f %7.1f %10.1f  %s\n", row.name, static_cast<long long>(r.ticks), static_cast<long long>(r.messages),
                r.peak_N, r.dose_s, r.cold_s, r.growth_kB, r.faults.empty() ? "none" : r.faults.c_str());
    std::fflush(stdout);
    violations += !r.faults.empty();
    out.push_back({{"row", row.name}, {"ticks", r.ticks}, {"messages", r.messages}, {"peak_N", r.peak_N}, {"warmth_s", r.dose_s},
                   {"cold_s", r.cold_s}, {"growth_kB", r.growth_kB}, {"violations", r.faults}});
  }
  if (!options.json.empty()) std::ofstream(options.json) << out.dump(1) << "\n";
  return options.check && violations > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) try {
  Options options;
  CLI::App app{"Hostile messages on every channel of a cluster, in virtual time."};
  app.add_option("--ticks", options.ticks, "milliseconds of each row")->check(CLI::Range(100, 100'000'000))->capture_default_str();
  app.add_flag("--full", options.full, "10^6 ticks in all");
  app.add_option("--seed", options.seed, "seed of the messages and of the cluster")->capture_default_str();
  app.add_option("--only", options.only, "rows whose name contains this text");
  app.add_option("--json", options.json, "also write the figures to this file");
  app.add_flag("--check", options.check, "exit 1 when a row passes a limit or changes an output");
  CLI11_PARSE(app, argc, argv);
  return run(options);
} catch (const std::exception& e) {
  std::fprintf(stderr, "hostile_table: %s\n", e.what());
  return 1;
}
