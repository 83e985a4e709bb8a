// Errors and costs of rigid-body engines on the tasks of peer_tasks.h, at several time steps.
//
//    bin/peer_table [--task NAME]... [--engine NAME]... [--step MS]... [--share X] [--budget SECONDS] [--json FILE]
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "sim_node/world/engine.h"
#include "sync/node/node_options.h"
#include "tests/bench/peers/ode_peer.h"
#include "tests/bench/sim_node/peer_tasks.h"
#ifdef TACTUS_BULLET
#include "tests/bench/peers/bullet_peer.h"
#endif
#ifdef TACTUS_DART
#include "tests/bench/peers/dart_peer.h"
#endif

using namespace tactus;

namespace {

template <class Engine>
class PeerOf : public bench::Peer {
 public:
  PeerOf(const sim::WorldDef& world, const sim::Settings& settings) : engine_(world, settings) {}
  void add_force(int body, const Eigen::Vector3d& force_N) override {
    engine_.add_force(body, force_N, engine_.bodies()[static_cast<std::size_t>(body)].centre_m);
  }
  void step() override { engine_.step(); }
  std::span<const sim::BodyMotion> bodies() const override { return engine_.bodies(); }

 private:
  Engine engine_;
};

template <class Engine>
bench::MakePeer maker(sim::Settings settings = {}) {
  return [=](const sim::WorldDef& world, double step_s) {
    sim::Settings own = settings;
    own.step_s = step_s;
    return std::make_unique<PeerOf<Engine>>(world, own);
  };
}

struct Named {
  std::string name;
  bench::MakePeer make;  // empty: not installed
};

std::vector<Named> all_engines() {
  sim::Settings quick, exact;
  quick.engine = exact.engine = "ode";
  exact.solver = "step";
  for (sim::Settings* s : {&quick, &exact})
    if (const std::string error = sim::apply_engine(*s); !error.empty()) throw std::runtime_error(error);
  std::vector<Named> out{{"tactus", maker<sim::Solver>()}, {"ode", maker<sim::test::OdePeer>(quick)}, {"ode_step", maker<sim::test::OdePeer>(exact)}, {"bullet", {}}, {"dart", {}}};
#ifdef TACTUS_BULLET
  out[3].make = maker<sim::test::BulletPeer>();
#endif
#ifdef TACTUS_DART
  out[4].make = maker<sim::test::DartPeer>();
#endif
  return out;
}

struct Options {
  std::vector<std::string> tasks, engines;
  std::vector<double> steps_ms;
  double share = 1, budget_s = 60;
  std::string json_file;
};

bool chosen(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

void require_known(const std::vector<std::string>& given, const std::vector<std::string>& known, const char* option) {
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  for (const std::string& name : given)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw std::runtime_error(std::string(option) + " " + name + " does not exist; choose from " + list);
}

nlohmann::ordered_json row(const bench::PeerTask& task, const std::string& engine, double step_ms, double seconds, const bench::PeerResult& r) {
  const bool complete = r.simulated_s > seconds - 1e-3 * step_ms;
  const auto number = [](double x) { return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(); };
  return {{"task", task.name}, {"unit", task.unit}, {"truth", task.truth}, {"engine", engine}, {"step_ms", step_ms},
          {"error", complete ? number(r.error) : nlohmann::ordered_json()}, {"step_us", r.step_us}, {"simulated_s", r.simulated_s}, {"seconds", seconds}};
}

void print(const nlohmann::ordered_json& r) {
  const std::string error = r["error"].is_null() ? "-" : [&] {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", r["error"].get<double>());
    return std::string(text);
  }();
  const bool stopped = r["error"].is_null();
  std::printf("%-12s %-9s %6g %12s %-3s %10.1f", r["task"].get<std::string>().c_str(), r["engine"].get<std::string>().c_str(), r["step_ms"].get<double>(),
              error.c_str(), r["unit"].get<std::string>().c_str(), r["step_us"].get<double>());
  if (stopped) std::printf("  ended after %.3g of %g s", r["simulated_s"].get<double>(), r["seconds"].get<double>());
  std::printf("\n");
  std::fflush(stdout);
}

// Runs a task in a process of its own, since an engine may end its process by an assertion. Then the error is NaN.
bench::PeerResult run_apart(const bench::PeerTask& task, const bench::MakePeer& make, double step_s, double seconds, double budget_s) {
  bench::PeerResult result;
  result.error = std::numeric_limits<double>::quiet_NaN();
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("there is no pipe left; close other programs");
  std::fflush(stdout);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process can be started; close other programs");
  if (child == 0) {
    const bench::PeerResult own = task.run(make, step_s, seconds, budget_s);
    _exit(write(ends[1], &own, sizeof own) == sizeof own ? 0 : 1);
  }
  close(ends[1]);
  bench::PeerResult read_result;
  if (read(ends[0], &read_result, sizeof read_result) == sizeof read_result) result = read_result;
  close(ends[0]);
  waitpid(child, nullptr, 0);
  return result;
}

void measure(const Options& o) {
  std::vector<std::string> task_names, engine_names;
  for (const bench::PeerTask& task : bench::peer_tasks()) task_names.push_back(task.name);
  const std::vector<Named> engines = all_engines();
  for (const Named& engine : engines) engine_names.push_back(engine.name);
  require_known(o.tasks, task_names, "--task");
  require_known(o.engines, engine_names, "--engine");
  for (const Named& engine : engines)
    if (chosen(o.engines, engine.name) && !engine.make)
      std::printf("skipped: %s was not installed when this program was built; run scripts/setup peers and build again\n", engine.name.c_str());
  auto rows = nlohmann::ordered_json::array();
  std::printf("%-12s %-9s %6s %12s %-3s %10s\n", "task", "engine", "ms", "error", "", "us/step");
  for (const bench::PeerTask& task : bench::peer_tasks())
    for (const double step_ms : o.steps_ms)
      for (const Named& engine : engines) {
        if (!chosen(o.tasks, task.name) || !chosen(o.engines, engine.name) || !engine.make) continue;
        const double seconds = o.share * task.seconds;
        rows.push_back(row(task, engine.name, step_ms, seconds, run_apart(task, engine.make, step_ms / 1000, seconds, o.budget_s)));
        print(rows.back());
      }
  if (!o.json_file.empty()) std::ofstream(o.json_file) << rows.dump(1) << "\n";
}

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app("Errors and costs of rigid-body engines on tasks with a known outcome");
  Options o;
  app.add_option("--task", o.tasks, "rolling, bouncing, 666, elastic_666, kapla, momentum or energy; several; default: all");
  app.add_option("--engine", o.engines, "tactus, ode, ode_step, bullet or dart; several; default: all that are installed");
  app.add_option("--step", o.steps_ms, "Time step, ms; several; default: 1, 2, 4, 8 and 16");
  app.add_option("--share", o.share, "Share of the duration of each task").range(0.001, 1.0);
  app.add_option("--budget", o.budget_s, "Longest time that a run may take, s").range(0.1, 3600.0);
  app.add_option("--json", o.json_file, "Writes the rows to this file");
  sync::parse_or_exit(app, "peer_table", argc, argv);
  if (o.steps_ms.empty()) o.steps_ms = {1, 2, 4, 8, 16};
  for (const double step : o.steps_ms)
    if (!(step >= 0.01 && step <= 100)) throw std::runtime_error("--step must be from 0.01 to 100 ms");
  measure(o);
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "peer_table: %s\n", e.what());
  return 1;
}
