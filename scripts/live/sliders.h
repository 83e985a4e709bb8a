// Between the page's sliders and a degradation profile: what the profile in force says is shown, and what a slider
// changes is changed in it, while all else that it says stays. Pure.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scripts/live/browser_message.h"

namespace tactus::live {

// What the sliders of each sense show of a profile: the first value that counts always and for all contacts.
struct Shown {
  Sliders sliders;
  bool more = false;  // the profile says more of this sense than its sliders show
};
// Throws std::invalid_argument with one sentence when that is no profile; "" is one that degrades nothing.
std::map<std::string, Shown> shown_of(const std::string& profile);
// {"name": ..., "senses": {sense: {delay_ms, rate_Hz, loss, more}}}, as pages are told it.
nlohmann::json told_of(const std::string& profile);

// The profile with the sliders at these places: a value that a slider has not changed stays as it was written,
// with its kind, its burst and its phase. Throws as above, also when the result is none.
std::string slid(const std::string& profile, const std::map<std::string, Sliders>& senses);

}  // namespace tactus::live
