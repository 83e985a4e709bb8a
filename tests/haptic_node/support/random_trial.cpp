#include <algorithm>
#include <cmath>
#include <sstream>
#include <variant>
#include <vector>

#include "tests/haptic_node/support/trial.h"

namespace tactus::haptic::test {
namespace {

double draw(std::mt19937& random, double from, double to) {
  const double u = static_cast<double>(random() >> 5) * 0x1p-27;
  return from > 0 ? from * std::pow(to / from, u) : from + (to - from) * u;
}

void draw_setting(std::mt19937& random, const sync::SettingField<Settings>& entry, Settings& settings) {
  if (const auto number = std::get_if<double Settings::*>(&entry.field)) {
    settings.**number = draw(random, entry.row.min, entry.row.max);
  } else if (const auto word = std::get_if<std::string Settings::*>(&entry.field)) {
    std::vector<std::string> words{""};
    for (const char* c = entry.row.unit; *c; ++c)
      if (*c == '|')
        words.emplace_back();
      else
        words.back() += *c;
    settings.**word = words[random() % words.size()];
  }
}

// The allowance of the settings, and half a millijoule for the error of the estimate (haptic_node/safety/README.md).
double max_generated_mJ(const TrialDef& def) { return 1e3 * def.settings.generated_limit_J + 0.5; }

}  // namespace

std::string random_force_operators(std::mt19937& random) {
  std::ostringstream text;
  const auto chance = [&](double p) { return draw(random, 0, 1) < p; };
  if (chance(0.7)) {
    const double delay_ms = draw(random, 0, 150);
    text << " delay=\"" << delay_ms << "ms\"";
    if (chance(0.3)) text << " jitter=\"" << draw(random, 0, 0.9) * delay_ms << "ms uniform\"";
  }
  if (chance(0.3)) text << " loss=\"" << draw(random, 0, 40) << "% burst=" << draw(random, 1, 20) << (chance(0.3) ? "\" conceal=\"zero\"" : "\"");
  if (chance(0.3)) text << " rate=\"" << draw(random, 10, 500) << "Hz\"";
  if (chance(0.3)) text << " quantise=\"" << draw(random, 0.05, 2) << "N\"";
  if (chance(0.3)) text << " gain=\"" << draw(random, 0, 5) - 2 << "\"";
  if (chance(0.3)) text << " lowpass=\"" << draw(random, 1, 200) << "Hz\"";
  if (chance(0.5)) {
    text << " deadband=\"" << draw(random, 0, 90) << "% force" << (chance(0.5) ? " predict=linear" : "");
    if (chance(0.3)) text << " floor=" << draw(random, 0, 2) << "N";
    if (chance(0.3)) text << " adaptive=" << draw(random, 0, 5) << "s/m";
    if (chance(0.3)) text << " resend=" << draw(random, 1, 200) << "ms";
    text << "\"";
  }
  if (chance(0.4)) text << " passivity=\"tdpa\"";
  if (chance(0.1)) text << " freeze=\"hold\" from=\"0.5s\"";
  return text.str().empty() ? " off=\"true\"" : text.str();
}

TrialDef random_trial(std::mt19937& random) {
  TrialDef d;
  // All settings, or a few beside their defaults.
  const unsigned every = random() % 2 ? 1 : 8;
  for (const auto& entry : setting_fields())
    if (random() % every == 0) draw_setting(random, entry, d.settings);
  Settings& s = d.settings;
  d.hand = {std::max(s.hand_mass_kg, s.device_mass_kg), std::max(s.hand_damping_Ns_m, s.device_damping_Ns_m),
            s.hand_stiffness_N_m, std::max(s.hand_inertia_kgm2, s.device_inertia_kgm2),
            std::max(s.hand_turn_damping_Nms_rad, s.device_turn_damping_Nms_rad), s.hand_turn_stiffness_Nm_rad};
  d.mass_kg = random() % 2 ? 0 : draw(random, 0.05, 2);
  d.stiffness_N_m = draw(random, 100, 20000);
  d.delay_ms = random() % 2 ? 0 : static_cast<int>(draw(random, 1, 200));
  if (d.mass_kg == 0 && random() % 2) d.margin_m = 0.008, d.margin_s = 0.03;
  d.force_step_N = random() % 2 ? 0 : draw(random, 1e-3, 100);
  d.hits = random() % 2 == 0;
  d.period_s = draw(random, 0.2, 1);
  d.hold_s = draw(random, 0.01, 0.5) * d.period_s;
  d.depth_m = draw(random, 0.001, 0.03);
  d.top_m = draw(random, 0.002, 0.05);
  d.taps = std::max(1, static_cast<int>(1 / d.period_s));
  d.failure = static_cast<Failure>(random() % kFailures);
  d.failure_s = draw(random, 0.2, 0.9);
  d.stall_s = d.failure == Failure::kStall ? draw(random, 0.001, 0.4) : 0;
  if (random() % 2) d.force_operators = random_force_operators(random);
  if (random() % 4 == 0) d.action_ms = static_cast<int>(draw(random, 1, 200));
  if (d.mass_kg > 0) return d;
  if (random() % 2) d.margin_late_m = 0.1;
  // Flat enough that the energy of the relief itself is below 0.1 mJ: a slope of 0.08.
  if (random() % 4 == 0) d.relief_m = draw(random, 1e-4, 5e-4);
  return d;
}

std::string faults(const TrialDef& def, const TrialResult& r) {
  std::string list;
  const auto require = [&](bool good, const char* fault) {
    if (!good) list += (list.empty() ? "" : ", ") + std::string(fault);
  };
  constexpr double kRounding_N = 1e-9;
  require(r.finite, "not finite");
  require(r.generated_mJ <= max_generated_mJ(def), "energy");
  require(r.beyond_force_N <= kRounding_N, "force limit");
  // Ticks fall on whole nanoseconds.
  require(r.beyond_rise_N <= kRounding_N + 2e-9 * def.settings.slew_limit_N_s, "slew limit");
  require(r.beyond_fade_N <= kRounding_N, "fade");
  if (def.failure != Failure::kNone) return list;
  const bool staged = !def.force_operators.empty();
  if (staged && !def.hits) require(r.injected_mJ <= max_generated_mJ(def), "injected energy");
  // One percent, and the rest of a tick and of a transient.
  const double reaction_N_s = 0.01 * r.received_N_s + 1e-4;
  // Coarse steps do not render the small force that returns the impulse of a transient.
  if (def.force_step_N == 0 && r.rung_down && !staged)
    require(std::abs(r.hand_N_s - r.constraint_N_s) <= reaction_N_s, "reaction of the hand");
  // A late force is partly on its way at the end.
  if (def.mass_kg > 0 && def.action_ms == 0) require(std::abs(r.body_N_s + r.constraint_N_s) <= reaction_N_s, "reaction of the body");
  return list;
}

std::string describe(const TrialDef& def) {
  std::ostringstream out;
  const Settings plain;
  for (const auto& entry : setting_fields()) {
    if (const auto number = std::get_if<double Settings::*>(&entry.field))
      if (def.settings.**number != plain.**number) out << entry.row.name << "=" << def.settings.**number << " ";
    if (const auto word = std::get_if<std::string Settings::*>(&entry.field))
      if (def.settings.**word != plain.**word) out << entry.row.name << "=" << def.settings.**word << " ";
  }
  out << "| hand " << def.hand.mass_kg << " kg " << def.hand.damping_N_s_m << " N s/m " << def.hand.stiffness_N_m
      << " N/m, body " << def.mass_kg << " kg, " << def.stiffness_N_m << " N/m, delay " << def.delay_ms << " ms, action " << def.action_ms << " ms, margin "
      << def.margin_m << " m and " << def.margin_late_m << " m, relief " << def.relief_m << " m, force_step " << def.force_step_N << " N, stage force" << def.force_operators << ", hits " << def.hits << ", tap " << def.period_s
      << " s " << def.hold_s << " s " << def.depth_m << " m " << def.top_m << " m, failure "
      << static_cast<int>(def.failure) << " at " << def.failure_s << " s, stall " << def.stall_s << " s";
  return out.str();
}

std::string describe(const TrialResult& r) {
  std::ostringstream out;
  out << "generated " << r.generated_mJ << " mJ, observed " << r.observed_mJ << " mJ, injected " << r.injected_mJ << " mJ, energy " << r.energy_mJ
      << " mJ, impulses of hand, constraint and body " << r.hand_N_s << ", " << r.constraint_N_s << ", " << r.body_N_s
      << " N s, peak " << r.peak_N << " N, beyond force " << r.beyond_force_N << " rise " << r.beyond_rise_N << " fade "
      << r.beyond_fade_N << " N, least coupling " << r.least_coupling;
  return out.str();
}

}  // namespace tactus::haptic::test
