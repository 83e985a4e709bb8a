#include "thermal_node/display/quality.h"

#include <string>

namespace tactus::thermal {
namespace {

// Share of a tick; the rest covers late wake-ups and other processes (design).
constexpr double kBudget = 0.5;
constexpr double kCalm_s = 2;  // design: spare time required before a better step

}  // namespace

Quality::Quality(const Settings& s)
    : ladder_(steps(), sync::from_seconds(kBudget / s.rate_Hz), static_cast<int>(kCalm_s * s.rate_Hz)),
      fixed_step_(s.quality == "auto" ? -1 : std::stoi(s.quality)) {}

}  // namespace tactus::thermal
