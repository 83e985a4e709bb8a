// Converts between the page's sliders and a degradation profile: the sliders show the profile in force, and a moved slider
// changes only its own value in it. Pure.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scripts/live/browser_message.h"

namespace tactus::live {

// {"name": ..., "senses": {sense: {delay_ms, rate_Hz, loss, deadband, choices: {name: value}, more}}, "stages": [sense, ...], "controls": {sense: {deadband,
// choices: [{name, of, values}, ...]}}}, as sent to pages: for each modality the first values that apply at all times and to all contacts. A stage of a
// modality is a sense "MODALITY:STAGE"; stages: all. controls: those of a stage beside delay, rate and loss, from the descriptors of the stages
// (sync/degradation/profile.h); of: the slider that must be above 0 for a choice to have an effect, or "". more: the profile has more operators of this modality
// than its controls show. Throws std::invalid_argument with one sentence for an invalid profile; "" degrades nothing.
nlohmann::json degradation_json(const std::string& profile);

// The profile with the sliders at these positions: a value that a slider has not changed stays as written, with its kind, its
// burst and its phase. Throws as above, also for an invalid result, and for a moved slider beyond its range (Sliders).
std::string with_sliders(const std::string& profile, const std::map<std::string, Sliders>& senses);

}  // namespace tactus::live
