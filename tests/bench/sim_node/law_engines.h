// Engines whose worlds law_table checks.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/sim_node/support/mechanics_laws.h"

namespace tactus::bench {

struct LawEngine {
  std::string name;
  bool reports_contacts = true;  // otherwise nothing is known of held bodies and events
  std::function<sim::test::LawReport(const sim::test::RandomWorld&)> check;
};

// Names for --engine: tactus (the settings as given), ode (quick), ode_step, bullet.
const std::vector<std::string>& law_engine_names();

// Empty: the engine was not installed when this program was built. Throws std::runtime_error with one sentence for an engine
// that contradicts the settings.
std::optional<LawEngine> law_engine(const std::string& name, const sim::Settings& settings, bool repeat);

}  // namespace tactus::bench
