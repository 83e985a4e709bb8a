// Parser of the setting `plots`. Pure.
//
//   graph TOOL_STATE.force_N.z@tool=0; bar NODE_HEALTH.rate_Hz@audio_node; text SYNC_REPORT.hits
//
// KIND CHANNEL.path[@process][@field=number]: only messages of that process, or only those in which a field, such
// as the tool, has that value.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/fields.h"

namespace tactus::visual {

struct PlotSpec {
  enum class Kind { kGraph, kBar, kText };
  Kind kind = Kind::kText;
  std::string channel;
  FieldPath value;
  std::vector<std::pair<FieldPath, double>> conditions;  // a message must meet all of them
  std::string title;                                     // as in the setting, without the kind

  // The value in a message of the channel; nothing when the conditions exclude it, or it has no such value.
  std::optional<std::variant<double, std::string>> read(std::span<const std::uint8_t> bytes) const;
};

inline constexpr std::size_t kMaxPlots = 12;

// Throws std::invalid_argument with one sentence that suggests the nearest names.
PlotSpec parse_plot(std::string_view text);
// The valid plots of the list, at most kMaxPlots; adds a sentence to `warnings` for each invalid one.
std::vector<PlotSpec> parse_plots(std::string_view list, std::vector<std::string>& warnings);

}  // namespace tactus::visual
