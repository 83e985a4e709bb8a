#include "tests/bench/sim_node/law_engines.h"

#include <cmath>
#include <stdexcept>

#include "sim_node/world/engine.h"
#include "tests/bench/peers/ode_peer.h"
#ifdef TACTUS_BULLET
#include "tests/bench/peers/bullet_peer.h"
#endif

namespace tactus::bench {
namespace {

using namespace tactus::sim;
using namespace tactus::sim::test;

template <class Engine>
LawReport checked(const RandomWorld& w, const Settings& settings, bool repeat) {
  LawReport report = LawCheckerOf<Engine>(w, settings).run();
  if (!repeat) return report;
  Engine again(w.world, settings);
  // A world with a value that is not finite ends early.
  for (auto left = std::lround(w.seconds / settings.step_s); left > 0 && report.finite; --left) again.step();
  report.repeats = !report.finite || hash_of(again.bodies()) == report.state;
  return report;
}

}  // namespace

const std::vector<std::string>& law_engine_names() {
  static const std::vector<std::string> names{"tactus", "ode", "ode_step", "bullet"};
  return names;
}

std::optional<LawEngine> law_engine(const std::string& name, const Settings& given, bool repeat) {
  Settings settings = given;
  if (name == "tactus") return LawEngine{name, true, [=](const RandomWorld& w) { return checked<Solver>(w, settings, repeat); }};
  if (name == "bullet") {
#ifdef TACTUS_BULLET
    return LawEngine{name, false, [=](const RandomWorld& w) { return checked<BulletPeer>(w, settings, repeat); }};
#else
    return std::nullopt;
#endif
  }
  settings.engine = "ode";
  if (name == "ode_step") settings.solver = "step";
  if (const std::string error = apply_engine(settings); !error.empty()) throw std::runtime_error(error);
  return LawEngine{name, true, [=](const RandomWorld& w) { return checked<OdePeer>(w, settings, repeat); }};
}

}  // namespace tactus::bench
