#include "haptic_node/quality.h"

#include <string>

namespace tactus::haptic {
namespace {

constexpr double kBudget =
    0.5;                       // share of a tick; design: the rest is for a wake-up that comes late and for others
constexpr double kCalm_s = 2;  // design: no better step without so much spare time

}  // namespace

Quality::Quality(const Settings& s)
    : ladder_(steps(), sync::from_seconds(kBudget / s.rate_Hz), static_cast<int>(kCalm_s * s.rate_Hz)),
      held_(s.quality == "auto" ? -1 : std::stoi(s.quality)) {}

}  // namespace tactus::haptic
