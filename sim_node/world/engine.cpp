#include "sim_node/world/engine.h"

#include <utility>

#include "sim_node/model/behaviour_model.h"

namespace tactus::sim {
namespace {

std::string contradiction(const std::string& engine, const char* setting, const std::string& value) {
  return "sim_node: engine = " + engine + " does not include " + setting + " = " + value + "; leave out one of the two";
}

}  // namespace

std::string apply_engine(Settings& s) {
  if (s.engine == "parts") return "";
  for (const auto& [setting, value] : {std::pair("solver", s.solver), std::pair("detector", s.detector)})
    if (value.starts_with("custom:")) return contradiction(s.engine, setting, value);
  const bool impulses = behaviour_model(s.solver).impulses;
  if (s.engine == "tactus") {
    if (!impulses) return contradiction(s.engine, "solver", s.solver);
    if (s.detector == "ode") return contradiction(s.engine, "detector", s.detector);
  } else if (s.engine == "ode") {
    // The default of the setting solver is impulse, so it counts as not set.
    if (impulses && s.solver != "impulse") return contradiction(s.engine, "solver", s.solver);
    if (s.detector != "auto" && s.detector != "ode") return contradiction(s.engine, "detector", s.detector);
    if (impulses) s.solver = "quick";
    s.detector = "ode";
    s.groups = "single";
  }
  return "";
}

}  // namespace tactus::sim
