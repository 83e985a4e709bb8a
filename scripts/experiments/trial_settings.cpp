#include "scripts/experiments/trial_settings.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace tactus::experiments {

TrialSettings::TrialSettings(const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    const auto at = word.find('=');
    if (at == std::string::npos || at == 0)
      throw std::invalid_argument("'" + word + "' is no setting; write NAME=VALUE");
    if (!values_.emplace(word.substr(0, at), word.substr(at + 1)).second)
      throw std::invalid_argument("the setting " + word.substr(0, at) + " occurs twice; remove one");
  }
}

double TrialSettings::number(const std::string& name, double low, double high) const {
  const auto found = values_.find(name);
  if (found == values_.end())
    throw std::invalid_argument("the setting " + name + " is missing; add " + name + "=");
  used_.insert(name);
  char* end = nullptr;
  const double value = std::strtod(found->second.c_str(), &end);
  if (found->second.empty() || *end != '\0' || !(value >= low && value <= high))
    throw std::invalid_argument(name + "=" + found->second + " is not a number from " + std::to_string(low) +
                                " to " + std::to_string(high));
  return value;
}

double TrialSettings::number_or(const std::string& name, double fallback, double low, double high) const {
  return values_.count(name) ? number(name, low, high) : fallback;
}

std::string TrialSettings::word(const std::string& name, std::initializer_list<const char*> allowed) const {
  used_.insert(name);
  const auto found = values_.find(name);
  if (found == values_.end()) return *allowed.begin();
  if (std::find(allowed.begin(), allowed.end(), found->second) != allowed.end()) return found->second;
  std::string all;
  for (const char* one : allowed) all += (all.empty() ? "" : ", ") + std::string(one);
  throw std::invalid_argument(name + "=" + found->second + " is unknown; choose from " + all);
}

void TrialSettings::require_all_used() const {
  for (const auto& [name, value] : values_)
    if (!used_.count(name)) throw std::invalid_argument("this paradigm has no setting " + name + "; remove it");
}

}  // namespace tactus::experiments
