// The settings of one trial, from the line that asks for it. Pure.
#pragma once

#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace tactus::experiments {

// The numbers that a trial answers, by name.
using Outcome = std::vector<std::pair<const char*, double>>;

// All functions throw std::invalid_argument with one sentence.
class TrialSettings {
 public:
  TrialSettings() = default;
  explicit TrialSettings(std::map<std::string, std::string> values) : values_(std::move(values)) {}
  // From words NAME=VALUE. A name that occurs twice is refused.
  explicit TrialSettings(const std::vector<std::string>& words);

  // A number in [low, high]; a missing one is refused.
  double number(const std::string& name, double low, double high) const;
  // A missing one is `fallback`.
  double number_or(const std::string& name, double fallback, double low, double high) const;
  // One of the allowed words; the first when it is missing.
  std::string word(const std::string& name, std::initializer_list<const char*> allowed) const;
  // Refuses settings that the trial did not use.
  void require_all_used() const;

 private:
  std::map<std::string, std::string> values_;
  mutable std::set<std::string> used_;
};

}  // namespace tactus::experiments
