#include "scripts/experiments/answering.h"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <stdexcept>

namespace tactus::experiments {
namespace {

std::uint64_t whole_number(const std::string& text, std::uint64_t most) {
  if (text.empty() || text.size() > 10 || text.find_first_not_of("0123456789") != std::string::npos ||
      std::stoull(text) > most)
    throw std::invalid_argument("'" + text + "' is not a whole number from 0 to " + std::to_string(most));
  return std::stoull(text);
}

const observer::ParameterRange* range_of(const std::string& name) {
  for (const observer::ParameterRange& range : observer::parameter_ranges())
    if (name == range.name) return &range;
  for (const TimingRange& timing : timing_ranges())
    if (name == timing.range.name) return &timing.range;
  return nullptr;
}

}  // namespace

std::string TrialDesk::answer(const std::string& line) {
  try {
    return answered(line);
  } catch (const std::exception& e) {
    return std::string("error ") + e.what();
  }
}

std::string TrialDesk::answered(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  constexpr std::uint64_t kMaxParticipant = 4095, kMaxNumber = 4294967295;
  if (words.size() == 3 && words[0] == "participant") {
    participant_ = std::make_unique<Participant>(
        static_cast<std::uint32_t>(whole_number(words[1], kMaxParticipant)), whole_number(words[2], kMaxNumber));
    return "ok";
  }
  if (words.size() < 3 || words[0] != "trial")
    throw std::invalid_argument("a line is 'participant INDEX SEED' or 'trial PARADIGM NUMBER [NAME=VALUE]...'");
  if (!participant_) throw std::invalid_argument("there is no participant; begin with 'participant INDEX SEED'");
  const TrialSettings settings(std::vector<std::string>(words.begin() + 3, words.end()));
  std::string text = "ok";
  for (const auto& [name, value] :
       run_trial(words[1], *participant_, settings, whole_number(words[2], kMaxNumber))) {
    char number[64];
    std::snprintf(number, sizeof number, " %s=%.9g", name, value);
    text += number;
  }
  return text;
}

std::string properties_table() {
  std::string text = "paradigm,property,evidence,source\n";
  for (const Paradigm& paradigm : paradigms()) {
    for (const char* name : paradigm.properties) {
      const observer::ParameterRange* range = range_of(name);
      if (range == nullptr) throw std::logic_error(std::string(paradigm.name) + ": there is no property " + name);
      text += std::string(paradigm.name) + "," + "\"" + name + "\"," + observer::evidence_name(range->evidence) +
              ",\"" + range->source + "\"\n";
    }
  }
  return text;
}

}  // namespace tactus::experiments
