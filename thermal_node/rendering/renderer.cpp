#include "thermal_node/rendering/renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "thermal_node/skin/bioheat_model.h"
#include "thermal_node/skin/skin_model.h"

namespace tactus::thermal {
namespace {

// For a material without a temperature.
constexpr double kRoom_degC = 23;
// Absolute zero, and the melting point of tungsten, the highest of a solid.
constexpr double kColdest_degC = -273.15, kHottest_degC = 3422;

std::unique_ptr<Skin> make_skin(const Settings& s) {
  if (s.model == "bioheat")
    return std::make_unique<BioheatModel>(
        Tissue{layers_of(s.site), s.skin_rest_degC, s.room_degC, s.perfusion_1_s, s.air_conductance_W_m2K});
  return std::make_unique<SkinModel>(SkinProperties{
      s.skin_rest_degC, effusivity(s.skin_conductivity_W_mK, s.skin_density_kg_m3, s.skin_specific_heat_J_kgK),
      s.perfusion_1_s, s.air_conductance_W_m2K});
}

// Excess over the range above which a plate counts as out of control; an overshoot is smaller.
constexpr double kRunaway_K = 2;
// Possible range of a plate under a finger; other values mean a broken sensor.
constexpr double kColdestPlate_degC = -50, kHottestPlate_degC = 150;

// A longer interval is integrated in at most this many substeps, so that a process that was stopped for hours
// continues at once. The implicit method is stable for any substep.
constexpr double kMaxSubsteps = 2000;

ControllerLimits limits(const Settings& s) {
  return {s.temperature_min_degC, s.temperature_max_degC, s.slew_max_K_s};
}

// Value to publish: an invalid quantity is published as 0.
float reading(double x) { return x > 0 && x < 1e9 ? static_cast<float>(x) : 0; }

bool usable(sync::SampleStatus status) {
  return status != sync::SampleStatus::kNone && status != sync::SampleStatus::kStale;
}

}  // namespace

Renderer::Renderer(const Settings& settings, std::vector<material_def_t> materials, int tool, int tool_body,
                   std::optional<double> element_degC, std::vector<double> thickness_m)
    : settings_(settings),
      materials_(std::move(materials)),
      thickness_m_(std::move(thickness_m)),
      tool_(tool),
      tool_body_(tool_body),
      late_{kLatePolicy, sync::from_seconds(settings.late_after_s), sync::from_seconds(settings.late_after_s)},
      skin_(make_skin(settings)),
      lag_(element_degC.value_or(settings.skin_rest_degC)),
      flux_lag_(0),
      display_({contact_conductance_W_m2K(settings.plate_conductivity_W_mK)}, make_skin(settings)),
      dwell_({settings.dose_max_s, settings.cold_below_degC, settings.cold_max_s}),
      controller_(limits(settings), element_degC.value_or(settings.skin_rest_degC)),
      commanded_degC_(element_degC.value_or(settings.skin_rest_degC)),
      target_degC_(commanded_degC_),
      exposure_{commanded_degC_, commanded_degC_} {}

ObjectProperties Renderer::object(const material_def_t& m, int body) const {
  const double degC = std::isfinite(m.temperature_degC) ? m.temperature_degC : kRoom_degC;
  ObjectProperties object{std::clamp(degC, kColdest_degC, kHottest_degC),
                          effusivity(m.conductivity_W_mK, m.density_kg_m3, m.specific_heat_J_kgK)};
  if (object.effusivity > 0 && m.conductivity_W_mK > 0) {
    object.conductivity_W_mK = m.conductivity_W_mK;
    object.heat_capacity_J_m3K = m.density_kg_m3 * m.specific_heat_J_kgK;
  }
  if (body >= 0 && body < static_cast<int>(thickness_m_.size()))
    object.thickness_m = thickness_m_[static_cast<std::size_t>(body)];
  return object;
}

// Index of the object in the skin model, which keeps its heat; a new object replaces the one touched longest ago.
std::size_t Renderer::object_index(int body, int material) {
  const auto same = [&](const TouchedObject& t) {
    return t.body == body && t.material == material && t.touched >= 0;
  };
  auto found = std::find_if(touched_objects_.begin(), touched_objects_.end(), same);
  if (found == touched_objects_.end()) {
    found = std::min_element(touched_objects_.begin(), touched_objects_.end(),
                             [](const TouchedObject& a, const TouchedObject& b) { return a.touched < b.touched; });
    *found = {material, body, tick_};
    skin_->set_object(object(materials_[static_cast<std::size_t>(material)], body),
                      static_cast<std::size_t>(found - touched_objects_.begin()));
  }
  found->touched = tick_;
  return static_cast<std::size_t>(found - touched_objects_.begin());
}

// Means over the tick hide that the tool may touch only for a part of it, with more force. The conductance is
// therefore taken at the force and area of the touch itself and then weighted with its time.
void Renderer::add(HeatExchange& sum, const sync::ContactPart& c, double interval_s) {
  const double contact_s = sync::to_seconds(c.contact_time);
  if (!(contact_s > 0) || !(interval_s > 0) || c.material < 0 || c.material >= static_cast<int>(materials_.size()))
    return;
  const double conductance =
      contact_conductance_W_m2K(materials_[static_cast<std::size_t>(c.material)].conductivity_W_mK);
  const double time_share = std::min(1.0, contact_s / interval_s);
  const Press press{settings_.reference_force_N, settings_.reference_area_m2, settings_.pressure_exponent};
  const double pressed = std::min(
      time_share * contact_share(c.force_N / time_share, c.area_m2 / time_share, press), 1 - sum.pressed_share);
  sum.pressed_share += pressed;
  const double covered = c.area_m2 > 0 ? std::min(1.0, c.area_m2 / time_share / settings_.reference_area_m2) : 0;
  sum.conductance_W_m2K[object_index(c.body, c.material)] += conductance * pressed;
  sum.touched_share = std::min(1.0, sum.touched_share + covered * time_share);
}

// Adds touches that ended before the interval of this tick but arrive only now, so that their heat is not lost.
// The force follows from the momentum of a plastic impact, m v, over the time of touch, as in
// sync/resampling/contact_integral.cpp.
void Renderer::add_missed_touches(HeatExchange& sum, const Tick& tick, double interval_s) {
  for (const contact_event_t& end : tick.events) {
    if (end.kind != contact_event_t::END || end.tool != tool_ || sync::sim_time(end.time_ns) > tick.sim_begin)
      continue;
    const auto begin = std::find_if(tick.events.begin(), tick.events.end(), [&](const contact_event_t& e) {
      return e.kind == contact_event_t::BEGIN && e.contact_id == end.contact_id;
    });
    if (begin == tick.events.end() || end.time_ns <= begin->time_ns) continue;
    sync::ContactPart c;
    c.contact_time = sync::Nanoseconds(end.time_ns - begin->time_ns);
    c.force_N = static_cast<double>(begin->effective_mass_kg) * begin->approach_speed_m_s / interval_s;
    c.material = begin->body_a == tool_body_ ? begin->material_b : begin->material_a;
    c.body = begin->body_a == tool_body_ ? begin->body_b : begin->body_a;
    add(sum, c, interval_s);
  }
}

// Heat is a slow state: an event is applied in the tick in which it becomes due, at any lateness, and never
// dropped. The report carries the end of the tick; the start of the change within the tick is known to half a
// tick.
void Renderer::report(const contact_event_t& event, const Tick& tick) {
  if (event.tool != tool_ || event.kind == contact_event_t::END) return;
  presentation_t r{};
  r.event_id = event.event_id;
  r.part = presentation_t::WHOLE;
  const sync::HostTime due = tick.map.to_host(sync::sim_time(event.time_ns)) + tick.delay;
  r.scheduled_ns = std::max<std::int64_t>(0, sync::to_ns(due));
  r.presented_ns = sync::to_ns(tick.end);
  r.uncertainty_ns = (sync::from_seconds(1 / settings_.rate_Hz) / 2).count();
  r.outcome = late_.outcome(tick.end - due);
  reports_.push_back(r);
}

double Renderer::load_W() const { return display_.finger_flux_W_m2() * settings_.reference_area_m2; }

double Renderer::neutral_degC() const {
  return std::clamp(settings_.skin_rest_degC, settings_.temperature_min_degC, settings_.temperature_max_degC);
}

// A trouble outlasts its cause by kTrust_s, so that a display that is good now and then stays at rest.
DisplayState Renderer::check_display(const TickOptions& options, bool measured, bool gap, double interval_s) {
  using Result = Following::Result;
  DisplayState state = DisplayState::kGood;
  if (measured && options.check_following && !gap) {
    const Result result = following_.step(commanded_degC_, options.plate->plate_degC, options.plate->limited,
                                          neutral_degC(), interval_s);
    if (result != Result::kFollows)
      state = result == Result::kShort ? DisplayState::kShort : DisplayState::kNotFollowing;
  } else {
    following_.skip();
  }
  const bool runaway = options.plate && (!measured || options.plate->fault ||
                                         options.plate->plate_degC < settings_.temperature_min_degC - kRunaway_K ||
                                         options.plate->plate_degC > settings_.temperature_max_degC + kRunaway_K);
  if (runaway) state = DisplayState::kFault;
  if (options.display_lost) state = DisplayState::kLost;

  distrust_s_ = std::max(0.0, distrust_s_ - interval_s);
  if (state == DisplayState::kFault || state == DisplayState::kLost) {
    distrust_s_ = kTrust_s;
    last_trouble_ = state;
  }
  return distrust_s_ > 0 && state != DisplayState::kNotFollowing ? last_trouble_ : state;
}

DwellAccount Renderer::account_after(double seconds) const {
  Dwell ahead = dwell_;
  ahead.step(exposure_, seconds, {settings_.temperature_min_degC, settings_.temperature_max_degC});
  return ahead.account();
}

// From the wanted skin state to the plate command: lag, then the required plate temperature, then the limits, the
// tightest last. The range is entered at once, with any slew limit. A display that cannot be relied on is
// commanded to rest. The exposure is that of the last interval, by the worse of command and reading: no reading
// lowers it.
Command Renderer::command(const TickOptions& options, double interval_s) {
  const bool measured = options.plate && options.plate->plate_degC > kColdestPlate_degC &&
                        options.plate->plate_degC < kHottestPlate_degC;
  const double plate_degC = measured ? options.plate->plate_degC : commanded_degC_;
  const TemperatureRange wide{settings_.temperature_min_degC, settings_.temperature_max_degC};
  exposure_ = {std::max(plate_degC, commanded_degC_),
               std::min(plate_degC, commanded_degC_),
               target_degC_,
               options.plate_return_K_s,
               kReaction_s + interval_s,
               kPlateSwing_K};
  TemperatureRange range = dwell_.step(exposure_, interval_s, wide);
  range.min_degC = std::min(range.min_degC, neutral_degC());  // a neutral of 25 degC at cold_below remains allowed

  const bool gap = interval_s > sync::to_seconds(Device::kSilence);
  if (gap) {
    controller_ = Controller(limits(settings_), neutral_degC());
    lag_.set(neutral_degC());
    flux_lag_.set(0);
  }
  display_state_ = check_display(options, measured, gap, interval_s);

  const double skin_degC = lag_.step(skin_->surface_degC(), interval_s, options.response_s);
  const double flux_W_m2 = flux_lag_.step(skin_->heat_flux_W_m2(), interval_s, options.response_s);
  const double plate_target =
      display_.step(skin_degC, flux_W_m2, plate_degC, interval_s, options.longest_substep_s);
  double wanted = settings_.display == "flux" ? plate_target : skin_degC;
  if (display_state_ == DisplayState::kShort)
    wanted = std::clamp(wanted, std::min(neutral_degC(), plate_degC - Following::kTolerance_K / 2),
                        std::max(neutral_degC(), plate_degC + Following::kTolerance_K / 2));
  const bool rest = input_lost_ || gap || !std::isfinite(wanted) ||
                    (display_state_ != DisplayState::kGood && display_state_ != DisplayState::kShort);
  if (rest) wanted = settings_.skin_rest_degC;

  target_degC_ = std::clamp(wanted, range.min_degC, range.max_degC);
  const double slew_K_s = rest ? std::max(kReturn_K_s, settings_.slew_max_K_s) : settings_.slew_max_K_s;
  controller_.set_limits({range.min_degC, range.max_degC, slew_K_s});
  Command command = controller_.step(wanted, interval_s);
  command.limited = command.limited || (rest && !input_lost_) || display_state_ == DisplayState::kShort;
  commanded_degC_ = command.command_degC;
  if (rest) {
    lag_.set(command.command_degC);
    flux_lag_.set(0);
  }
  return command;
}

thermal_state_t Renderer::step(const Tick& tick, const TickOptions& tick_options) {
  reports_.clear();
  for (const contact_event_t& event : tick.events) report(event, tick);

  const double interval_s = std::max(0.0, sync::to_seconds(tick.end - tick.begin));
  TickOptions options = tick_options;
  options.longest_substep_s = std::max(options.longest_substep_s, interval_s / kMaxSubsteps);
  const bool lost = input_lost_ = !usable(tick.contact.status);
  ++tick_;
  HeatExchange e;
  if (interval_s > 0) add_missed_touches(e, tick, interval_s);
  e.pressed_share = 0;  // each missed touch had the whole pad
  if (!lost) {
    // The strongest contacts, if there are more than the models hold.
    std::vector<sync::ContactPart> parts = tick.contact.parts;
    std::stable_sort(parts.begin(), parts.end(),
                     [](const auto& a, const auto& b) { return a.force_N > b.force_N; });
    parts.resize(std::min(parts.size(), Skin::kMaxObjects));
    for (const sync::ContactPart& part : parts) add(e, part, tick.contact_interval_s());
  }
  skin_->step(interval_s, e.conductance_W_m2K, e.touched_share, options.longest_substep_s);
  const Command command = this->command(options, interval_s);

  thermal_state_t out{};
  out.header.sim_time_ns = std::max<std::int64_t>(-1, sync::to_ns(tick.sim_end));
  out.tool = tool_;
  const auto most = std::max_element(e.conductance_W_m2K.begin(), e.conductance_W_m2K.end());
  out.material =
      *most > 0 ? touched_objects_[static_cast<std::size_t>(most - e.conductance_W_m2K.begin())].material : -1;
  out.force_N = lost ? 0 : reading(tick.contact.force_N);
  out.area_m2 = lost ? 0 : reading(tick.contact.area_m2);
  out.heat_flux_W_m2 = static_cast<float>(skin_->heat_flux_W_m2());
  out.skin_degC = static_cast<float>(skin_->surface_degC());
  out.commanded_degC = static_cast<float>(command.command_degC);
  out.limited = command.limited ? 1 : 0;
  return out;
}

}  // namespace tactus::thermal
