// play_games: plays games of the simulated player in virtual time, one after the other, each with its own seed and profile.
//
// It reads one JSON line for each game from stdin and writes one to stdout; the line of a failed game contains the reason.
// The scene is read once. Each game is a forked process, so that state or a crash of one game cannot affect another, and one
// seed gives the same game in any order.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "audio_node/run.h"
#include "haptic_node/run.h"
#include "scripts/simulated_player/observer_admission.h"
#include "scripts/simulated_player/player_choice.h"
#include "scripts/simulated_player/rules.h"
#include "scripts/simulated_player/run.h"
#include "scripts/virtual_time/referee.h"
#include "sim_node/run.h"
#include "sim_node/scene/load_sdf.h"
#include "sim_node/scene/scene_folders.h"
#include "sync/node/node_options.h"
#include "sync/text/error_text.h"
#include "sync/tools/sync_node.h"
#include "sync/virtual_time/virtual_time.h"
#include "thermal_node/run.h"
#include "visual_node/run.h"

using namespace tactus;
using nlohmann::json;

namespace {

constexpr sync::Nanoseconds kRunStep{50'000'000};
constexpr sync::Nanoseconds kWorldStartTimeout{400'000'000'000};  // above the maxima of scene_grace and ready_timeout (sim_node/settings.csv)

struct Loaded {
  std::string scene, out;
  std::vector<std::string> scatter;
  sim::WorldDef world;
  simulated_player::Rules rules;
  sync::WirePlan wire;
};

struct GameDef {
  std::uint64_t seed = 1;
  double limit_s = 30;
  std::string profile;  // XML; empty: none
  std::string player;   // as --player of simulated_player; empty: its default
  std::uint64_t population = 1;
  int practice = 0;
  std::string checks = "require";  // as --checks of simulated_player
};

// Runs a program with these arguments, as main() gets them.
int run_with(std::vector<std::string> words, const std::function<int(int, char**)>& program) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  return program(static_cast<int>(words.size()), argv.data());
}

// Throws std::runtime_error with one sentence.
GameVerdict play(const Loaded& loaded, const GameDef& game) {
  std::vector<std::string> common{"--seed", std::to_string(game.seed), "--run-id", "1", "--out", loaded.out};
  std::vector<std::string> degraded = common;
  if (!game.profile.empty()) {
    const std::string file = loaded.out + "/profile.xml";
    if (!(std::ofstream(file) << game.profile).flush())
      throw std::runtime_error("cannot write " + file + "; choose another --out");
    degraded.insert(degraded.end(), {"--degrade", file});
  }
  const auto words = [](std::vector<std::string> own, const std::vector<std::string>& more) {
    own.insert(own.end(), more.begin(), more.end());
    return own;
  };
  sync::VirtualPlan plan;
  plan.seed = game.seed;
  plan.wire = loaded.wire;
  sync::VirtualTime time(plan);
  Referee referee;
  time.wire().add_listener([&](sync::HostTime, std::string_view channel, std::span<const std::uint8_t> data) {
    referee.on_message(channel, data);
  });
  const auto add = [&](const std::string& name, std::vector<std::string> line,
                       std::function<int(int, char**)> program) {
    time.add(name, [line = std::move(line), program = std::move(program)] { return run_with(line, program); });
  };
  add("sync_node", words({"sync_node"}, degraded), sync::run_sync_node);
  add("haptic_node", words({"haptic_node", "--device", "external:participant"}, degraded), haptic::run);
  add("audio_node", words({"audio_node", "--no-sound"}, degraded), audio::run);
  add("visual_node", words({"visual_node", "--no-pictures"}, degraded), visual::run);
  add("thermal_node", words({"thermal_node"}, degraded), thermal::run);
  std::vector<std::string> player = words({"simulated_player", loaded.scene, "--device", "participant"}, loaded.scatter);
  if (!game.player.empty())
    player.insert(player.end(), {"--player", game.player, "--population", std::to_string(game.population), "--practice",
                                 std::to_string(game.practice), "--checks", "skip"});
  add("participant", words(player, degraded),
      [&](int argc, char** argv) { return simulated_player::run(argc, argv, &loaded.rules); });
  add("sim_node", words({"sim_node", loaded.scene, "--await", "participant"}, degraded),
      [&](int argc, char** argv) { return sim::run(argc, argv, &loaded.world); });
  const sync::HostTime latest = time.now() + kWorldStartTimeout;
  while (!referee.begun() && time.now() < latest) time.run_for(kRunStep);
  if (!referee.begun()) throw std::runtime_error("the world does not begin");
  const sync::HostTime until = time.now() + sync::from_seconds(game.limit_s);
  while (time.now() < until && !referee.decided()) time.run_for(kRunStep);
  for (const char* name : {"sync_node", "haptic_node", "audio_node", "visual_node", "thermal_node", "participant", "sim_node"})
    if (time.result(name) > 0) throw std::runtime_error(std::string(name) + " ended too early");
  return referee.verdict();
}

json play_to_json(const Loaded& loaded, const GameDef& game) try {
  const GameVerdict v = play(loaded, game);
  const bool won = v.won && v.time_s <= game.limit_s;
  return {{"won", won},       {"time_s", won ? v.time_s : game.limit_s}, {"filled", v.filled},
          {"wrong", v.wrong}, {"peak_force_N", v.peak_force_N},          {"path_m", v.path_m}};
} catch (const std::exception& e) {
  return {{"trouble", sync::error_text(e)}};
}

// The last line that a game wrote to stderr, for the reason of its failure.
std::string last_line(int fd) {
  std::string text(4096, '\0');
  const off_t size = lseek(fd, 0, SEEK_END);
  const off_t from = std::max<off_t>(0, size - static_cast<off_t>(text.size()));
  const ssize_t got = pread(fd, text.data(), text.size(), from);
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

json play_in_process(const Loaded& loaded, const GameDef& game) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw std::runtime_error(std::string("cannot create a pipe to a game: ") + std::strerror(errno));
  const int stderr_fd = memfd_create("game", MFD_CLOEXEC);
  const pid_t parent = getpid(), child = fork();
  if (child < 0) throw std::runtime_error(std::string("cannot start a process for a game: ") + std::strerror(errno));
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
    if (stderr_fd >= 0) dup2(stderr_fd, STDERR_FILENO);
    const std::string line = play_to_json(loaded, game).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    for (std::size_t done = 0; done < line.size();) {
      const ssize_t n = write(ends[1], line.data() + done, line.size() - done);
      if (n <= 0) _exit(1);
      done += static_cast<std::size_t>(n);
    }
    _exit(0);
  }
  close(ends[1]);
  std::string line;
  char part[4096];
  for (ssize_t n = 0; (n = read(ends[0], part, sizeof part)) > 0;) line.append(part, static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  json result = json::parse(line, nullptr, false);
  if (!result.is_object())
    result = {{"trouble", "the game's process ended with status " + std::to_string(status)}};
  if (result.contains("trouble") && stderr_fd >= 0) result["said"] = last_line(stderr_fd);
  close(stderr_fd);
  return result;
}

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app(
      "Plays games of the simulated player in virtual time: a JSON line on stdin for each, "
      "{\"game\": NAME, \"seed\": N, \"limit_s\": S, \"profile\": XML, \"player\": NAME, \"population\": SEED, \"practice\": N, \"checks\": RULE}, "
      "and one on stdout.");
  Loaded loaded;
  std::string
      along = "0.08",
      aside = "0.08";  // design: the balls of the dark room stay apart from each other and from the objects there
  app.add_option("SCENE", loaded.scene, "SDF file of a world with a game").required().existing_file();
  std::vector<std::string> folders;
  sim::add_scene_folder_option(app, folders);
  app.add_option("--out", loaded.out, "empty folder for the output of the nodes").required().existing_folder();
  app.add_option("--scatter-along", along, "half range of the balls' start positions towards or away from their holes, m")
      .show_default();
  app.add_option("--scatter-aside", aside, "half range of the balls' start positions to the side, m").show_default();
  double latency_ms = 0, jitter_ms = 0, loss_percent = 0;
  app.add_option("--latency-ms", latency_ms, "latency of the bus, ms").range(0.0, 10000.0).show_default();
  app.add_option("--jitter-ms", jitter_ms, "mean of the additional latency of the bus, ms; heavy-tailed").range(0.0, 10000.0);
  app.add_option("--loss-percent", loss_percent, "share of lost datagrams on the bus, percent").range(0.0, 100.0);
  sync::parse_or_exit(app, "play_games", argc, argv);
  loaded.wire.latency = sync::from_seconds(latency_ms * 1e-3);
  if (jitter_ms > 0) loaded.wire.jitter = {.shape = sync::JitterShape::kPareto, .scale_s = jitter_ms * 1e-3};
  loaded.wire.loss = {.share = loss_percent / 100};
  loaded.scatter = {"--scatter-along", along, "--scatter-aside", aside};
  std::vector<std::string> warnings;
  loaded.world = sim::load_sdf(loaded.scene, warnings, {.folders = sim::scene_folders(folders)});
  loaded.rules = simulated_player::read_rules(loaded.scene, folders);
  simulated_player::Admission admission;
  for (std::string line; std::getline(std::cin, line);) {
    const json request = json::parse(line, nullptr, false);
    if (!request.is_object() || !request.contains("game") || !request["game"].is_string())
      throw std::runtime_error("this line names no game: " + line.substr(0, 200));
    json result;
    try {
      GameDef game;
      game.seed = request.value("seed", game.seed), game.limit_s = request.value("limit_s", game.limit_s);
      game.profile = request.value("profile", ""), game.player = request.value("player", "");
      game.population = request.value("population", game.population), game.practice = request.value("practice", game.practice);
      game.checks = request.value("checks", game.checks);
      std::vector<int> failed;
      if (!game.player.empty())
        failed = admission.admit(simulated_player::player_choice(game.player), game.population, simulated_player::check_policy(game.checks));
      result = play_in_process(loaded, game);
      if (!failed.empty()) result["failed_checks"] = failed;
    } catch (const json::exception& e) {
      throw std::runtime_error(
          "a game is {\"game\": NAME, \"seed\": N, \"limit_s\": S, \"profile\": XML}, which this line is not: " +
          line.substr(0, 200));
    }
    result["game"] = request["game"];
    if (request.contains("player")) result["player"] = request["player"];
    std::cout << result.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
    if (!std::cout) return 1;
  }
  return 0;
} catch (const std::exception& e) {
  return sync::fail("play_games", e);
}
