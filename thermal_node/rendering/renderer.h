// Thermal rendering of one tool: contacts in; skin temperature, command and presentation reports out. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <tactus/contact_event_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/thermal_state_t.hpp>
#include <vector>

#include "sync/presentation/late.h"
#include "thermal_node/devices/device.h"
#include "thermal_node/display/controller.h"
#include "thermal_node/display/flux_display.h"
#include "thermal_node/display/following.h"
#include "thermal_node/display/lag.h"
#include "thermal_node/display/ticks.h"
#include "thermal_node/settings.gen.h"
#include "thermal_node/skin/contact_model.h"
#include "thermal_node/skin/dwell.h"
#include "thermal_node/skin/skin.h"

namespace tactus::thermal {

// Heat is a slow state: late events still apply.
inline constexpr sync::LateRule kLatePolicy = sync::LateRule::kAlwaysApply;

// Slowest return of a plate. Design: half of the rate of the default element.
inline constexpr double kDisplayReturn_K_s = 10;

// Operators of a profile, quality and reading of the display in one tick.
struct TickOptions {
  double response_s = 0;  // time constant of a display that is slow on purpose; 0: none
  double longest_substep_s = Skin::kLongestSubstep_s;
  std::optional<PlateReading>
      plate{};                  // reading of the display since the last tick; empty: assumed to be at its command
  bool display_lost = false;    // the display cannot be relied on: its plate is commanded to rest
  bool check_following = true;  // false: the readings belong to other commands
  double plate_return_K_s = kDisplayReturn_K_s;
};

// How the display performs; all but kGood and kShort command the plate to rest.
enum class DisplayState {
  kGood,
  kShort,         // delivers less than commanded: the command stays near the plate
  kLost,          // TickOptions::display_lost
  kFault,         // reports a fault, an impossible temperature, or one beyond the range
  kNotFollowing,  // claims to follow, but is elsewhere; until restart_display()
};

class Renderer {
 public:
  // materials: of the scene. tool, tool_body: index of the tool in the scene and its body. element_degC:
  // temperature of the element from the previous scene; empty: at resting skin. thickness_m: by body, see
  // thickness.h; bodies beyond its end count as infinite.
  Renderer(const Settings& settings, std::vector<material_def_t> materials, int tool, int tool_body,
           std::optional<double> element_degC = std::nullopt, std::vector<double> thickness_m = {});

  // The state to publish at tick.end; of the header only the simulated instant is filled. Stale or missing input
  // counts as no contact; the command then returns to the resting temperature, independent of skin model, quality
  // and slew limit. After a gap of more than Device::kSilence the command begins at rest, because a display
  // without commands has returned there.
  thermal_state_t step(const Tick& tick, const TickOptions& options = {});

  // Applies changed settings from the next step on, as far as they can change while it runs.
  void change(const Settings& settings) {
    settings_.reference_force_N = settings.reference_force_N;
    settings_.pressure_exponent = settings.pressure_exponent;
  }

  // Estimated heat from the finger to the plate, W.
  double load_W() const;

  // Accumulated warm and cold exposure of the skin; pass it to resume() when the scene changes, because the skin
  // is the same.
  const Dwell& dwell() const { return dwell_; }
  void resume(const Dwell& before) { dwell_.resume(before); }
  void resume(const DwellAccount& before) { dwell_.resume(before); }
  // The exposure as it will be if the plate stays where it is for this time.
  DwellAccount account_after(double seconds) const;

  // Slowest return of the command to rest, also with a tighter slew limit: from any command within a second.
  // Design: the default of slew_max.
  static constexpr double kReturn_K_s = 20;
  // Design: time for which the display must be good before it is used again.
  static constexpr double kTrust_s = 1;
  // Time until a display leaves its command, besides the tick: Device::kSilence if this process stops, and the way
  // of the message (design).
  static constexpr double kReaction_s = 0.4;

  DisplayState display() const { return display_state_; }
  // Another display begins.
  void restart_display() { following_.restart(); }
  // True when the last step had no reliable input.
  bool input_lost() const { return input_lost_; }

  // Reports of the begin and hit events of the own tool in the last step, each exactly once.
  const std::vector<presentation_t>& reports() const { return reports_; }

 private:
  // Means over the tick.
  struct HeatExchange {
    std::array<double, Skin::kMaxObjects> conductance_W_m2K{};  // to each object under the skin
    double touched_share = 0;                                   // of the pad and of the time
    double pressed_share = 0;  // share of the conductance of the whole pad, firmly pressed: at most 1
  };
  // An object that the models hold under the skin.
  struct TouchedObject {
    int material = -1, body = -1;
    std::int64_t touched = -1;  // last tick in which it was touched
  };
  void add(HeatExchange& sum, const sync::ContactPart& part, double interval_s);
  void add_missed_touches(HeatExchange& sum, const Tick& tick, double interval_s);
  std::size_t object_index(int body, int material);
  ObjectProperties object(const material_def_t& material, int body) const;
  void report(const contact_event_t& event, const Tick& tick);
  double neutral_degC() const;
  DisplayState check_display(const TickOptions& options, bool measured, bool gap, double interval_s);
  Command command(const TickOptions& options, double interval_s);

  Settings settings_;
  std::vector<material_def_t> materials_;
  std::vector<double> thickness_m_;
  int tool_;
  int tool_body_;
  sync::LatePolicy late_;
  std::unique_ptr<Skin> skin_;
  Lag lag_, flux_lag_;
  FluxDisplay display_;
  Dwell dwell_;
  Controller controller_;
  double commanded_degC_;
  double target_degC_;  // of the command
  Exposure exposure_;
  Following following_;
  DisplayState display_state_ = DisplayState::kGood, last_trouble_ = DisplayState::kGood;
  double distrust_s_ = 0;  // remaining
  std::array<TouchedObject, Skin::kMaxObjects> touched_objects_{};
  std::int64_t tick_ = 0;
  bool input_lost_ = true;
  std::vector<presentation_t> reports_;
};

}  // namespace tactus::thermal
