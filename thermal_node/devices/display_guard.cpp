#include "thermal_node/devices/display_guard.h"

#include <algorithm>
#include <cmath>

#include "thermal_node/display/following.h"
#include "thermal_node/display/plate_controller.h"

namespace tactus::thermal {
namespace {

// As of the command, see Renderer.
constexpr double kReturn_K_s = 20, kReaction_s = 0.4;
// As of Device::return_K_s of a display that another program drives.
constexpr double kPlateReturn_K_s = Following::kSlowest_K_s;

}  // namespace

DisplayGuard::DisplayGuard(const Settings& s, int tool, std::int64_t run_id, std::int32_t clock)
    : settings_(s),
      neutral_degC_(std::clamp(s.skin_rest_degC, s.temperature_min_degC, s.temperature_max_degC)),
      tool_(tool),
      sender_(Device::kSilence, clock, run_id),
      dwell_({s.dose_max_s, s.cold_below_degC, s.cold_max_s}),
      controller_({s.temperature_min_degC, s.temperature_max_degC, s.slew_max_K_s}, neutral_degC_),
      target_degC_(neutral_degC_),
      plate_degC_(neutral_degC_),
      exposure_{neutral_degC_, neutral_degC_} {}

void DisplayGuard::receive(const thermal_state_t& m, sync::HostTime arrival) {
  if (m.tool != tool_) return;
  const DatedSender::Result result = sender_.observe(m.header, arrival);
  if (result == DatedSender::Result::kUse || result == DatedSender::Result::kRestart) command_ = m;
}

const char* DisplayGuard::problem(sync::HostTime now) const {
  if (sender_.conflict(now))
    return "two programs send THERMAL_STATE for its tool: the plate is neutral; stop one of them";
  if (sender_.ahead(now))
    return "THERMAL_STATE is dated ahead: the plate is neutral; check the clock of thermal_node";
  if (sender_.followed() == 0) return "waits for THERMAL_STATE";
  if (sender_.silent(now)) return "no THERMAL_STATE: the plate is neutral";
  if (!sender_.trusted(now)) return "THERMAL_STATE has begun: the plate is neutral for a moment";
  return std::isfinite(command_.commanded_degC) ? nullptr : "the command is not a number: the plate is neutral";
}

// A plate that was cold when the display was switched on must be heated.
bool DisplayGuard::runs_away(double plate_degC) const {
  constexpr PlateLimits limits;
  return plate_degC > limits.plate_max_degC + kRunaway_K ||
         (plate_degC < limits.plate_min_degC - kRunaway_K && plate_degC < plate_degC_);
}

GuardedTarget DisplayGuard::step(std::optional<double> plate_degC, sync::HostTime now) {
  const double dt_s = std::max(0.0, sync::to_seconds(now - stepped_.value_or(now)));
  const bool first = !stepped_;
  stepped_ = now;
  const bool failed = plate_degC && !std::isfinite(*plate_degC);
  const double plate = plate_degC && !failed ? *plate_degC : target_degC_;
  const TemperatureRange wide{settings_.temperature_min_degC, settings_.temperature_max_degC};
  exposure_ = {std::max(plate, target_degC_),
               std::min(plate, target_degC_),
               target_degC_,
               kPlateReturn_K_s,
               kReaction_s + dt_s,
               kPlateSwing_K};
  TemperatureRange range = dwell_.step(exposure_, dt_s, wide);
  range.min_degC = std::min(range.min_degC, neutral_degC_);  // a neutral of 25 degC at cold_below remains allowed

  GuardedTarget out;
  out.problem = problem(now);
  if (failed) out.problem = "its sensor has failed: the display is off";
  if (!first && runs_away(plate))
    out.problem = "its plate is out of the range: the display is off until it is back";
  out.off = failed || (!first && runs_away(plate));
  plate_degC_ = plate;

  // A display that was not stepped for long begins at neutral.
  if (dt_s > sync::to_seconds(Device::kSilence))
    controller_ = Controller({wide.min_degC, wide.max_degC, settings_.slew_max_K_s}, neutral_degC_);
  const bool neutral = out.problem != nullptr;
  const double wanted = neutral ? neutral_degC_ : command_.commanded_degC;
  // thermal_node enters a range that has become narrower at once, so no slew limit delays the way to neutral.
  const bool returns = std::abs(wanted - neutral_degC_) < std::abs(target_degC_ - neutral_degC_);
  controller_.set_limits({range.min_degC, range.max_degC,
                          returns ? std::max(kReturn_K_s, settings_.slew_max_K_s) : settings_.slew_max_K_s});
  const Command command = controller_.step(wanted, dt_s);
  out.target_degC = target_degC_ = command.command_degC;
  out.limited = command.limited || neutral;
  if (!neutral) {
    const double load_W = command_.heat_flux_W_m2 * settings_.reference_area_m2;
    if (std::isfinite(load_W)) out.load_W = std::clamp(load_W, -kMaxLoad_W, kMaxLoad_W);
  }
  return out;
}

DwellAccount DisplayGuard::account_after(double seconds) const {
  Dwell ahead = dwell_;
  ahead.step(exposure_, seconds, {settings_.temperature_min_degC, settings_.temperature_max_degC});
  return ahead.account();
}

}  // namespace tactus::thermal
