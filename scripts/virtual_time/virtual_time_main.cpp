// virtual_time: runs a cluster in one process, on a simulated clock and a simulated bus. Its nodes are the live ones, with
// the same options; with one seed, their output is the same to the bit.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "audio_node/run.h"
#include "haptic_node/run.h"
#include "scripts/simulated_player/run.h"
#include "scripts/virtual_time/rerun_hand.h"
#include "sim_node/run.h"
#include "sync/node/node_options.h"
#include "sync/tools/recorder/recorder_node.h"
#include "sync/tools/sync_node.h"
#include "sync/virtual_time/virtual_time.h"
#include "thermal_node/run.h"
#include "visual_node/run.h"

using namespace tactus;

namespace {

const std::map<std::string, std::function<int(int, char**)>> kPrograms{
    {"sim_node", [](int argc, char** argv) { return sim::run(argc, argv); }},
    {"haptic_node", haptic::run},
    {"audio_node", audio::run},
    {"visual_node", visual::run},
    {"thermal_node", thermal::run},
    {"sync_node", sync::run_sync_node},
    {"recorder", sync::run_recorder},
    {"rerun_hand", run_rerun_hand},
    {"simulated_player", [](int argc, char** argv) { return simulated_player::run(argc, argv); }},
};

using Words = std::vector<std::string>;

constexpr sync::Nanoseconds kRunStep{100'000'000};
constexpr sync::Nanoseconds kWorldStartTimeout{400'000'000'000};  // above the maxima of scene_grace and ready_timeout (sim_node/settings.csv)
constexpr sync::Nanoseconds kFinalPresentations{300'000'000};  // time to present and report the last events, beyond intended delays
constexpr std::chrono::seconds kProgressPeriod{5};

// One line of the plan.
struct PlannedProgram {
  std::string name;
  Words words;  // the program first
};

volatile std::sig_atomic_t stop_requested = 0;

// A word of the plan: a text, or {"hex": "..."} with the bytes of one that is not UTF-8, such as the name of a folder.
std::optional<std::string> word_of(const nlohmann::json& entry) {
  if (entry.is_string()) return entry.get<std::string>();
  if (!entry.is_object() || entry.size() != 1 || !entry.contains("hex") || !entry["hex"].is_string()) return std::nullopt;
  const auto digits = entry["hex"].get<std::string>();
  if (digits.size() % 2 != 0 || digits.find_first_not_of("0123456789abcdef") != std::string::npos) return std::nullopt;
  std::string bytes;
  for (std::size_t at = 0; at < digits.size(); at += 2) bytes += static_cast<char>(std::stoi(digits.substr(at, 2), nullptr, 16));
  return bytes;
}

std::vector<PlannedProgram> read_plan(const std::string& file) {
  std::ifstream in(file);
  const nlohmann::json plan = nlohmann::json::parse(in, nullptr, false);
  const std::string wrong = file + " is not a plan; write {\"NAME\": [\"PROGRAM\", \"OPTION\", ...], ...}";
  if (!plan.is_object() || plan.empty()) throw std::runtime_error(wrong);
  std::vector<PlannedProgram> programs;
  for (const auto& [name, words] : plan.items()) {
    programs.push_back({name, {}});
    if (words.is_array())
      for (const auto& entry : words)
        if (auto word = word_of(entry)) programs.back().words.push_back(std::move(*word));
    if (!words.is_array() || words.empty() || programs.back().words.size() != words.size())
      throw std::runtime_error(wrong + "; the entry " + name + " is not such a list");
    const std::string program = std::filesystem::path(programs.back().words.front()).filename();
    if (!kPrograms.contains(program)) throw std::runtime_error(program + " does not run in virtual time; leave it out of " + file);
    programs.back().words.front() = program;
  }
  return programs;
}

int run_program(const Words& given) {
  Words words = given;
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  return kPrograms.at(words.front())(static_cast<int>(words.size()), argv.data());
}

// Ends the simulation first, so that all modalities present its last events; the recorder last, so that the log is complete.
// delay: longest intended delay of a presentation.
void stop_in_order(sync::VirtualTime& time, const std::vector<PlannedProgram>& programs, sync::Nanoseconds delay) {
  const auto request_stop = [&](auto&& selects) {
    for (const PlannedProgram& program : programs)
      if (selects(program.words.front())) time.request_stop(program.name);
    time.run_for(kFinalPresentations);
  };
  request_stop([](const std::string& program) { return program == "sim_node"; });
  time.run_for(delay);
  request_stop([](const std::string& program) { return program != "sync_node" && program != "recorder"; });
  request_stop([](const std::string& program) { return program == "sync_node"; });
  time.end();
}

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app("Runs the nodes of a cluster in one process, in virtual time.");
  std::string file;
  double seconds = 10, last_presentations_s = 0, latency_ms = 0, jitter_ms = 0, loss_percent = 0;
  sync::VirtualPlan plan;
  app.add_option("PLAN", file, "command lines of the nodes, JSON: {\"NAME\": [\"PROGRAM\", \"OPTION\", ...], ...}")
      .required()
      .existing_file();
  app.add_option("--seconds", seconds, "simulated time to run after the start of the world, s").positive().show_default();
  app.add_option("--last-presentations", last_presentations_s, "longest intended delay of a presentation: time after the world for its last events, s")
      .range(0.0, 120.0);
  app.add_option("--seed", plan.seed, "seed of identities, phases of loops, and the bus").show_default();
  app.add_option("--latency-ms", latency_ms, "latency of the bus, ms").range(0.0, 10000.0).show_default();
  app.add_option("--jitter-ms", jitter_ms, "mean of the additional latency of the bus, ms; heavy-tailed").range(0.0, 10000.0);
  app.add_option("--loss-percent", loss_percent, "share of lost datagrams on the bus, percent").range(0.0, 100.0);
  sync::parse_or_exit(app, "virtual_time", argc, argv);
  const std::vector<PlannedProgram> programs = read_plan(file);
  plan.wire = {.latency = sync::from_seconds(latency_ms * 1e-3),
               .jitter = {.shape = sync::JitterShape::kPareto, .scale_s = jitter_ms * 1e-3},
               .loss = {.share = loss_percent / 100}};
  if (jitter_ms == 0) plan.wire.jitter = {};

  // A signal that the caller ignores stays ignored.
  for (const int signal : {SIGINT, SIGTERM})
    if (std::signal(signal, [](int) { stop_requested = 1; }) == SIG_IGN) std::signal(signal, SIG_IGN);
  sync::VirtualTime time(plan);
  std::optional<sync::HostTime> world_start;
  time.wire().add_listener([&](sync::HostTime now, std::string_view channel, std::span<const std::uint8_t>) {
    if (!world_start && channel == channels::kWorldState) world_start = now;
  });
  for (const PlannedProgram& program : programs) time.add(program.name, [&] { return run_program(program.words); });
  const auto begun = std::chrono::steady_clock::now();
  auto next_progress = begun + kProgressPeriod;
  // A world that stops by itself ends the run; the other programs do not.
  const auto world_lost = [&] {
    return std::any_of(programs.begin(), programs.end(), [&](const auto& p) { return p.name == "sim_node" && time.result(p.name) > 0; });
  };
  while (!world_start && !stop_requested && !world_lost() && time.now() < sync::VirtualTime::kBegin + kWorldStartTimeout) time.run_for(kRunStep);
  if (!world_start && !stop_requested && !world_lost()) throw std::runtime_error("the world does not begin; add a sim_node with a readable scene to the plan");
  const sync::HostTime until = world_start.value_or(time.now()) + sync::from_seconds(seconds);
  while (time.now() < until && !stop_requested && !world_lost()) {
    time.run_until(std::min(until, time.now() + kRunStep));
    if (const auto now = std::chrono::steady_clock::now(); now >= next_progress) {
      next_progress = now + kProgressPeriod;
      std::cerr << "virtual_time: " << sync::to_seconds(time.now() - *world_start) << " of " << seconds << " s" << std::endl;
    }
  }
  const bool lost = world_lost();
  stop_in_order(time, programs, stop_requested ? sync::Nanoseconds(0) : sync::from_seconds(last_presentations_s));
  const double real_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  const double virtual_s = sync::to_seconds(time.now() - sync::VirtualTime::kBegin);
  std::cerr << "virtual_time: " << virtual_s << " s in " << real_s << " s, " << virtual_s / real_s << " times as fast as real time; "
            << time.wire().sent() << " messages sent" << std::endl;
  if (lost) throw std::runtime_error("sim_node ended; see its message above");
  return 0;
} catch (const std::exception& e) {
  return sync::fail("virtual_time", e);
}
