#include "sync/playout/policy.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "sync/degradation/known_modalities.h"
#include "sync/text/settings.h"

namespace tactus::sync {
namespace {

constexpr std::array<const char*, 5> kPolicyNames{"asap", "aligned", "experiment", "local_haptic_first", "itouch2005"};
constexpr double kMax_s = 60;
// Known modalities in the order of the loop of I-Touch (Pocheville 2005), which their tables give; then unknown ones by name.
std::vector<std::string> serial_order(const std::map<std::string, Nanoseconds>& needed) {
  std::vector<std::string> order;
  for (const auto& [name, time] : needed) order.push_back(name);
  std::stable_sort(order.begin(), order.end(), [](const std::string& a, const std::string& b) {
    return modality_index(a) < modality_index(b);
  });
  return order;
}

bool is_local(const std::string& modality) {
  const KnownModality* known = known_modality(modality);
  return known && known->kind == PlayoutKind::kLocal;
}

// The longest need of the modalities that are waited for.
Nanoseconds common_delay(const PlayoutPlan& plan, const std::map<std::string, Nanoseconds>& needed,
                         const std::set<std::string>& slow) {
  if (plan.aligner == AlignerKind::kFixed) return std::min(plan.base, plan.budget);
  Nanoseconds max_need{0};
  for (const auto& [name, time] : needed)
    if (time <= plan.budget && !slow.contains(name)) max_need = std::max(max_need, time);
  return max_need;
}

}  // namespace

Policy parse_policy(const std::string& word) {
  for (std::size_t i = 0; i < kPolicyNames.size(); ++i)
    if (word == kPolicyNames[i]) return static_cast<Policy>(i);
  throw std::invalid_argument("there is no policy \"" + word +
                              "\"; choose asap, aligned, experiment, local_haptic_first or itouch2005");
}

const char* name_of(Policy policy) { return kPolicyNames[static_cast<std::size_t>(policy)]; }

void PlayoutPlan::check() const {
  if (policy != Policy::kExperiment && !soa.empty())
    throw std::invalid_argument("asynchronies need the policy experiment; choose it, or omit them");
  if (soa.size() > kMaxAsynchronies)
    throw std::invalid_argument("asynchronies are for at most " + std::to_string(kMaxAsynchronies) + " senses");
  for (const auto& [name, asynchrony] : soa)
    if (base + asynchrony < Nanoseconds(0))
      throw std::invalid_argument("the asynchrony of " + name +
                                  " requests a presentation before the event; choose a base of at least " +
                                  std::to_string((-asynchrony.count() + 999'999) / 1'000'000) + " ms");
}

Nanoseconds parse_duration(const std::string& text) {
  const double s = parse_quantity(text, "s");
  if (s < 0 || s > kMax_s) throw std::invalid_argument("\"" + text + "\" is not between 0 and 60 s");
  return from_seconds(s);
}

std::map<std::string, Nanoseconds> parse_soa(const std::string& text) {
  std::map<std::string, Nanoseconds> soa;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const auto equals = part.find('=');
    if (equals == std::string::npos || equals == 0)
      throw std::invalid_argument("\"" + part + "\" is not an asynchrony; write it as visual=-50ms");
    const double s = parse_quantity(part.substr(equals + 1), "s");
    if (std::abs(s) > kMax_s)
      throw std::invalid_argument("the asynchrony \"" + part + "\" is longer than 60 s");
    // A number without a unit is refused: 50 would be read as seconds, but usually means milliseconds.
    if (s != 0 && std::isdigit(static_cast<unsigned char>(part.back())))
      throw std::invalid_argument("the asynchrony \"" + part + "\" has no unit; write it as " + part + "ms or " + part + "s");
    soa[part.substr(0, equals)] = from_seconds(s);
  }
  return soa;
}

std::map<std::string, Nanoseconds> playout_delays(const PlayoutPlan& plan,
                                                  const std::map<std::string, Nanoseconds>& needed,
                                                  const std::set<std::string>& slow) {
  std::map<std::string, Nanoseconds> delays;
  for (const auto& [name, time] : needed) delays[name] = Nanoseconds(0);
  switch (plan.policy) {
    case Policy::kAsap: break;
    case Policy::kAligned:
    case Policy::kLocalHapticFirst: {
      auto others = needed;
      if (plan.policy == Policy::kLocalHapticFirst) std::erase_if(others, [](const auto& o) { return is_local(o.first); });
      for (const auto& [name, time] : others) delays[name] = common_delay(plan, others, slow);
      break;
    }
    case Policy::kExperiment:
      for (const auto& [name, asynchrony] : plan.soa) delays[name] = Nanoseconds(0);
      for (auto& [name, delay] : delays) {
        const auto requested = plan.soa.find(name);
        delay = std::max(Nanoseconds(0), plan.base + (requested == plan.soa.end() ? Nanoseconds(0) : requested->second));
      }
      break;
    case Policy::kItouch2005: {
      Nanoseconds sum{0};
      for (const std::string& name : serial_order(needed)) delays[name] = sum += needed.at(name);
      break;
    }
  }
  return delays;
}

double lockstep_rate_Hz(const PlayoutPlan& plan, const std::map<std::string, Nanoseconds>& needed) {
  Nanoseconds sum{0};
  for (const auto& [name, time] : needed) sum += time;
  return plan.policy == Policy::kItouch2005 && sum > Nanoseconds(0) ? 1 / to_seconds(sum) : 0;
}

}  // namespace tactus::sync
