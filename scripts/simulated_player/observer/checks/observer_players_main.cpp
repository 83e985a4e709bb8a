// observer_players: prints simulated players of the population, and the checks that a player passes or fails.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "scripts/simulated_player/observer/checks/checks.h"
#include "scripts/simulated_player/observer/population.h"
#include "sync/text/arguments.h"
#include "sync/text/csv.h"

namespace observer = tactus::observer;

namespace {

std::string cell(std::string_view text) { return tactus::sync::csv_cell(text); }

void print_properties() {
  std::printf("row,property,unit,low_5,median,high_95,evidence,source\n");
  for (const auto& r : observer::parameter_ranges())
    std::printf("%d,%s,%s,%g,%g,%g,%s,%s\n", r.row, cell(r.name).c_str(), cell(r.unit).c_str(), r.low, r.centre, r.high,
                cell(observer::evidence_name(r.evidence)).c_str(), cell(r.source).c_str());
}

void print_players(int count, std::uint64_t seed) {
  std::printf("player");
  for (const auto& r : observer::parameter_ranges()) std::printf(",%s", cell(std::string(r.name) + " [" + r.unit + "]").c_str());
  std::printf("\n");
  for (int i = 0; i < count; ++i) {
    const observer::PlayerParameters player = observer::player_of(static_cast<std::uint32_t>(i), seed);
    std::printf("%d", i);
    for (const auto& r : observer::parameter_ranges()) std::printf(",%.6g", player.*r.field / r.to_si);
    std::printf("\n");
  }
}

// Exit status 1 when a check fails.
int print_checks(const observer::PlayerParameters& player, std::uint64_t seed) {
  bool passed = true;
  std::printf("check,quantity,unit,value,low,high,verdict,published,evidence,source\n");
  for (const auto& r : observer::run_checks(player, seed)) {
    passed = passed && r.passed();
    std::printf("%d,%s,%s,%.5g,%.5g,%.5g,%s,%s,%s,%s\n", r.check, cell(r.quantity).c_str(), cell(r.unit).c_str(), r.value,
                r.low, r.high, r.passed() ? "pass" : "FAIL", cell(r.published).c_str(),
                cell(observer::evidence_name(r.evidence)).c_str(), cell(r.source).c_str());
  }
  return passed ? 0 : 1;
}

void print_admitted(int first, int count, std::uint64_t seed) {
  std::printf("population,player,admitted,first failing check\n");
  int admitted = 0;
  for (int i = first; i < first + count; ++i) {
    const auto failing =
        observer::failing_checks(observer::player_of(static_cast<std::uint32_t>(i), seed), seed, true);
    admitted += failing.empty();
    std::printf("%llu,%d,%s,%s\n", static_cast<unsigned long long>(seed), i, failing.empty() ? "yes" : "no",
                failing.empty() ? "" : std::to_string(failing.front()).c_str());
    std::fflush(stdout);
  }
  std::fprintf(stderr, "%d of %d players pass all checks\n", admitted, count);
}

// One line for each player with the verdict of each check, and a line with the number of players that fail each.
void print_table(int first, int count, std::uint64_t seed) {
  std::printf("player");
  for (int check = 1; check <= observer::kChecks; ++check) std::printf(",check %d", check);
  std::printf(",admitted\n");
  int admitted = 0;
  std::vector<int> failures(observer::kChecks + 1, 0);
  for (int i = first; i < first + count; ++i) {
    const auto failing = observer::failing_checks(observer::player_of(static_cast<std::uint32_t>(i), seed), seed);
    admitted += failing.empty();
    std::printf("%d", i);
    for (int check = 1; check <= observer::kChecks; ++check) {
      const bool fails = std::find(failing.begin(), failing.end(), check) != failing.end();
      failures[static_cast<std::size_t>(check)] += fails;
      std::printf(",%s", fails ? "FAIL" : "pass");
    }
    std::printf(",%s\n", failing.empty() ? "yes" : "no");
    std::fflush(stdout);
  }
  std::printf("failed");
  for (int check = 1; check <= observer::kChecks; ++check) std::printf(",%d", failures[static_cast<std::size_t>(check)]);
  std::printf(",%d of %d admitted\n", admitted, count);
}

}  // namespace

int main(int argc, char** argv) try {
  int count = 128, player = -1, first = 0;
  std::uint64_t seed = 1;
  tactus::sync::Arguments app("Simulated players that perceive and move as measured people do.");
  auto properties =
      app.add_command("properties", "print the properties of the players with ranges and sources, as CSV");
  auto players = app.add_command("players", "print the players of a population, as CSV");
  players.add_option("--count", count, "number of players").range(1, 1'000'000).show_default();
  players.add_option("--seed", seed, "seed of the population").show_default();
  auto check = app.add_command("check", "print the twelve checks of one player; exits 1 when one fails");
  check.add_option("--player", player, "number in the population; -1: the typical player")
      .range(-1, 1'000'000)
      .show_default();
  check.add_option("--seed", seed, "seed of the population and of the experiments").show_default();
  auto admit =
      app.add_command("admit", "print which players of a population pass all checks, and the first failing check of the others; up to 10 s for a player");
  admit.add_option("--first", first, "number of the first player").range(0, 1'000'000).show_default();
  admit.add_option("--count", count, "number of players").range(1, 1'000'000).show_default();
  admit.add_option("--seed", seed, "seed of the population and of the experiments").show_default();
  auto table = app.add_command("table", "print the verdict of each check for players of a population, as CSV; up to 10 s for a player");
  table.add_option("--first", first, "number of the first player").range(0, 1'000'000).show_default();
  table.add_option("--count", count, "number of players").range(1, 1'000'000).show_default();
  table.add_option("--seed", seed, "seed of the population and of the experiments").show_default();
  if (const auto help = app.parse(argc, argv)) {
    std::fputs(help->c_str(), stdout);
    return 0;
  }
  if (app.command() == "properties") print_properties();
  if (app.command() == "players") print_players(count, seed);
  if (app.command() == "check")
    return print_checks(
        player < 0 ? observer::PlayerParameters{} : observer::player_of(static_cast<std::uint32_t>(player), seed),
        seed);
  if (app.command() == "admit") print_admitted(first, count, seed);
  if (app.command() == "table") print_table(first, count, seed);
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "observer_players: %s\n", e.what());
  return 1;
}
