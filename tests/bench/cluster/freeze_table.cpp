// Every program of a cluster is stopped, and every channel interrupted, at random moments for random times (5 ms to 3 s), in
// virtual time: a stop is that of SIGSTOP and SIGCONT, without any influence of the machine.
//
//    bin/freeze_table [--count N] [--seed N] [--only TEXT] [--check] [--json FILE]
//
// Prints for each part: failures, largest force that remains after the promised time, force beyond the fade of its return,
// time until the hand feels a force again, delay of the plate on its way to neutral, and violations. The limits of force,
// energy, temperature, dose and sound count for the whole run. --check: exit 1 when there is a violation.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/bench/cluster/freeze_trial.h"
#include "tests/sync/support/temporary_folder.h"

using namespace tactus;
using namespace tactus::bench;

namespace {

constexpr double kShortest_s = 0.005, kLongest_s = 3;
constexpr double kSettle_s = 1.2;  // between two failures: the force has returned, and a tap follows

struct Options {
  int count = 50;
  unsigned seed = 1;
  std::string only, json;
  bool check = false;
};

struct PartFailures {
  const FailingPart* part;
  std::vector<FailureTime> failures;
};

double draw(std::mt19937& random, double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }

// Lets one part fail, and waits until the cluster has recovered.
FailureTime fail_once(const FailingPart& part, VirtualCluster& cluster, ClusterRecord& record, std::mt19937& random) {
  sync::VirtualTime& time = cluster.time();
  time.run_for(sync::from_seconds(draw(random, 0, 0.9)));  // a period of the hand
  const double length_s = std::exp(draw(random, std::log(kShortest_s), std::log(kLongest_s)));
  FailureTime at{time.now(), time.now() + sync::from_seconds(length_s), ""};
  record.reset_gaps(at.begin);
  part.channel ? time.wire().block(part.name, at.end) : static_cast<void>(time.freeze(part.name, at.end));
  time.run_until(at.end);
  time.run_for(sync::from_seconds(kSettle_s));
  at.gaps = record.long_gaps(time.now(), part.channel ? "" : part.name);
  return at;
}

nlohmann::json to_json(const FailingPart& part, const FailureResult& r) {
  return {{"part", part.name},           {"failures", r.failures},           {"longest_s", r.longest_s},
          {"remaining_N", r.remaining_N}, {"beyond_fade_N", r.beyond_fade_N}, {"return_s", r.longest_return_s},
          {"from_neutral_K", r.from_neutral_K}, {"louder", r.louder},         {"violations", r.faults}};
}

// Prints and counts the violations of limits in the whole run.
int print_limits(const ClusterRecord& record, const Sound& sound) {
  int violations = 0;
  const std::vector<std::pair<const char*, std::string>> all{{"force on the hand", record.force().faults()},
                                                             {"commanded temperature", record.commanded_heat().faults()},
                                                             {"plate", record.plate_heat().faults()},
                                                             {"sound", faults_of(sound)}};
  for (const auto& [what, faults] : all)
    if (!faults.empty()) ++violations, std::printf("beyond a limit: %s: %s\n", what, faults.c_str());
  std::printf("force up to %.2f N, rise beyond the limit %.3g N, energy %.3f J; commanded %.1f to %.1f degC, warmth %.1f s, cold %.1f s\n",
              record.force().peak_N(), record.force().beyond_rise_N(), record.force().energy_J(), record.commanded_heat().lowest_degC(),
              record.commanded_heat().highest_degC(), record.commanded_heat().dose_s(), record.commanded_heat().cold_s());
  return violations;
}

int run(const Options& options) {
  const sync::TemporaryFolder folder;
  ClusterRecord record;
  std::vector<PartFailures> parts;
  {
    VirtualCluster cluster(
        folder.path, options.seed, [&](const ArmTick& tick) { record.add(tick); },
        [&](sync::HostTime t, std::string_view channel, std::span<const std::uint8_t> data) { record.add(t, channel, data); });
    std::mt19937 random(options.seed);
    for (const FailingPart& part : kFailingParts) {
      if (std::string_view(part.name).find(options.only) == std::string_view::npos) continue;
      parts.push_back({&part, {}});
      for (int k = 0; k < options.count; ++k) parts.back().failures.push_back(fail_once(part, cluster, record, random));
    }
  }
  const Sound sound = read_sound(folder.path / "audio.wav");
  std::printf("%-15s %8s %9s %11s %11s %9s %9s %10s\n", "part", "failures", "longest/s", "remaining/N", "beyond fade", "return/s", "heat/K", "violations");
  nlohmann::json rows = nlohmann::json::array();
  int violations = print_limits(record, sound);
  for (const PartFailures& p : parts) {
    FailureResult r;
    for (const FailureTime& at : p.failures) {
      judge(*p.part, at, record, r);
      if (p.part->silences) judge_sound(at, record, sound, r);
    }
    std::printf("%-15s %8d %9.2f %11.3g %11.3g %9.3f %9.3g %10zu\n", p.part->name, r.failures, r.longest_s, r.remaining_N, r.beyond_fade_N,
                r.longest_return_s, r.from_neutral_K, r.faults.size());
    for (const std::string& fault : r.faults) std::printf("    %s\n", fault.c_str());
    violations += static_cast<int>(r.faults.size());
    rows.push_back(to_json(*p.part, r));
  }
  if (!options.json.empty()) std::ofstream(options.json) << rows.dump(1) << "\n";
  return options.check && violations > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) try {
  Options options;
  CLI::App app{"Stops every program and interrupts every channel of a cluster at random moments, in virtual time."};
  app.add_option("--count", options.count, "failures of each part")->check(CLI::Range(1, 100'000))->capture_default_str();
  app.add_option("--seed", options.seed, "seed of moments and lengths")->capture_default_str();
  app.add_option("--only", options.only, "parts whose name contains this text");
  app.add_option("--json", options.json, "also write the figures to this file");
  app.add_flag("--check", options.check, "exit 1 when there is a violation");
  CLI11_PARSE(app, argc, argv);
  return run(options);
} catch (const std::exception& e) {
  std::fprintf(stderr, "freeze_table: %s\n", e.what());
  return 1;
}
