#include "sync/degradation/known_senses.h"

#include <algorithm>
#include <map>

namespace tactus::sync {
namespace {

const std::map<std::string, std::vector<std::string>>& table() {
  static const std::map<std::string, std::vector<std::string>> senses{{"audio", {"dropout"}},
                                                                      {"haptic", {"force_step"}},
                                                                      {"thermal", {"response"}},
                                                                      {"visual", {"frame_rate", "resolution"}}};
  return senses;
}

}  // namespace

bool is_known_sense(const std::string& modality) { return table().contains(modality); }

std::string senses_with(const std::string& output_operator) {
  std::string names;
  for (const auto& [modality, has] : table())
    if (std::find(has.begin(), has.end(), output_operator) != has.end())
      names += (names.empty() ? "" : ", ") + modality;
  return names;
}

std::vector<std::string> known_output_operators(const std::string& modality) {
  const auto it = table().find(modality);
  return it == table().end() ? std::vector<std::string>{} : it->second;
}

}  // namespace tactus::sync
