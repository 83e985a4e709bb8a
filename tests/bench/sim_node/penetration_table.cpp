// Maximum penetration of bodies in every scene, by an oracle independent of the detectors that compute gaps: the default pairing of solver
// and detector, and others for comparison; at 1 ms and at 60 Hz.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "sim_node/behaviour/solver.h"
#include "sim_node/scene/load_sdf.h"
#include "sync/node/node_options.h"
#include "sync/text/settings.h"
#include "tests/sim_node/support/hard_scenes.h"
#include "tests/sim_node/support/penetration_oracle.h"

using namespace tactus;
using namespace tactus::sim;

namespace {

struct Outcome {
  double deepest_m = 0, at_s = 0, us_a_step = 0;
  int shape_a = -1, shape_b = -1;
  double found_m = 0;  // depth of that pair by the detector at that time; -1: not reported
  int through = 0;     // bodies at a place that they can reach only through another body
  long pieces = 0, separated = 0, held = 0, steps = 0;
};

Outcome measure(const test::HardScene& scene, const Settings& settings, bool through_counts) {
  Outcome out;
  Solver solver(scene.world, settings);
  test::PenetrationOracle oracle(scene.world);
  const auto n = static_cast<long>(scene.seconds / settings.step_s);
  for (out.steps = 1; out.steps <= n; ++out.steps) {
    const auto before = std::chrono::steady_clock::now();
    solver.step();
    out.us_a_step += std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - before).count() /
                     static_cast<double>(n);
    if (const auto* r = solver.report())
      out.pieces += r->substeps, out.separated += r->separation_rounds, out.held += r->reset_units;
    const auto d = oracle.deepest(solver.bodies());
    if (d.depth_m <= out.deepest_m) continue;
    out.deepest_m = d.depth_m, out.at_s = static_cast<double>(out.steps) * settings.step_s;
    out.shape_a = d.shape_a, out.shape_b = d.shape_b;
    out.found_m = -1;
    for (const Manifold& m : solver.contacts())
      if (std::minmax(m.shape_a, m.shape_b) == std::minmax(d.shape_a, d.shape_b))
        for (const ManifoldPoint& q : m.used()) out.found_m = std::max(out.found_m, q.depth_m);
  }
  for (std::size_t i = 0; i < scene.world.bodies.size() && through_counts; ++i) {
    const BodyDef& b = scene.world.bodies[i];
    const BodyMotion& m = solver.bodies()[i];
    if (!b.is_static && b.tool < 0 && m.centre_m.head<2>().cwiseAbs().maxCoeff() < 0.45 &&
        m.centre_m.z() < scene.floor_m)
      ++out.through;
  }
  return out;
}

const char* kind_of(const WorldDef& world, int shape) {
  if (shape < 0) return "none";
  constexpr const char* kNames[] = {"box", "sphere", "cylinder", "capsule", "plane", "mesh", "heightfield"};
  return kNames[static_cast<int>(world.shapes[static_cast<std::size_t>(shape)].kind)];
}

}  // namespace

int main(int argc, char** argv) {
  tactus::sync::Arguments app{"Largest penetration between bodies, scene by scene."};
  std::string json, only;
  bool default_only = false;
  double longest_s = 1.5;
  app.add_option("--json", json, "write the table here too");
  app.add_option("--scene", only, "only scenes whose name contains this");
  app.add_option("--seconds", longest_s, "of each scene at most").show_default();
  app.add_flag("--default-only", default_only, "only the default pairing");
  tactus::sync::parse_or_exit(app, "penetration_table", argc, argv);
  std::vector<test::HardScene> scenes = test::hard_scenes();
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(TACTUS_SOURCE_DIR "/sim_node/scenes"))
    if (entry.path().extension() == ".sdf") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  const std::size_t hard = scenes.size();
  for (const auto& file : files) {
    std::vector<std::string> warnings;
    scenes.push_back({file.stem(), load_sdf(file, warnings), 2, -1e9});
  }
  struct Pairing {
    std::string solver, detector;
  };
  std::vector<Pairing> pairings{{"impulse", "auto"}};
  if (!default_only)
    pairings.insert(
        pairings.end(),
        {{"impulse", "ccd"}, {"impulse", "layers"}, {"quick", "ode"}, {"quick", "layers"}, {"step", "ode"}});
  nlohmann::json table = nlohmann::json::array();
  std::printf("%-36s %-16s %6s %12s %8s %8s %8s %9s %6s %10s\n", "scene", "pairing", "step", "deepest, um",
              "at, s", "through", "pieces", "separated", "held", "us a step");
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    test::HardScene& scene = scenes[i];
    if (scene.name.find(only) == std::string::npos) continue;
    scene.seconds = std::min(scene.seconds, longest_s);
    for (const Pairing& p : pairings)
      for (const double h : {0.001, 1.0 / 60}) {
        Settings settings;
        sync::apply_settings(settings, setting_fields(), "sim_node", scene.world.settings, {"groups=single"});
        settings.solver = p.solver;
        settings.detector = p.detector;
        settings.step_s = h;
        nlohmann::json row{{"scene", scene.name}, {"solver", p.solver}, {"detector", p.detector}, {"step_s", h}};
        try {
          const Outcome o = measure(scene, settings, i < hard);
          std::printf("%-36s %-16s %4.1fms %12.2f %8.3f %8d %8.2f %9ld %6ld %10.1f  %s-%s found %.2f um\n",
                      scene.name.c_str(), (p.solver + " " + p.detector).c_str(), h * 1e3, o.deepest_m * 1e6,
                      o.at_s, o.through, static_cast<double>(o.pieces) / static_cast<double>(o.steps - 1),
                      o.separated, o.held, o.us_a_step, kind_of(scene.world, o.shape_a),
                      kind_of(scene.world, o.shape_b), o.found_m * 1e6);
          row.update({{"deepest_m", o.deepest_m},
                      {"at_s", o.at_s},
                      {"through", o.through},
                      {"us_a_step", o.us_a_step},
                      {"separated", o.separated},
                      {"held", o.held},
                      {"shapes", {o.shape_a, o.shape_b}}});
        } catch (const std::exception& e) {
          std::printf("%-36s %-16s %4.1fms %s\n", scene.name.c_str(), (p.solver + " " + p.detector).c_str(),
                      h * 1e3, e.what());
          row["refused"] = e.what();
        }
        std::fflush(stdout);
        table.push_back(row);
      }
  }
  if (!json.empty()) std::ofstream(json) << table.dump(1) << "\n";
}
