// What is to be plotted: the setting `plots`. Pure.
//
//   graph TOOL_STATE.force_N.z@tool=0; bar NODE_HEALTH.rate_Hz@audio_node; text SYNC_REPORT.hits
//
// KIND CHANNEL.path[@who][@field=number]: who is a process; a field that tells messages of a channel apart, as the
// tool.
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
  std::vector<std::pair<FieldPath, double>> conditions;  // all of which a message must meet
  std::string title;                                     // as written, without the kind

  // The value in a message of the channel; nothing when it is not meant, or holds no such value.
  std::optional<std::variant<double, std::string>> read(std::span<const std::uint8_t> bytes) const;
};

inline constexpr std::size_t kMaxPlots = 12;

// Throws std::invalid_argument with one sentence, which gives the names that are nearest.
PlotSpec parse_plot(std::string_view text);
// Those of the list that can be drawn, at most kMostPlots; a sentence for each that cannot.
std::vector<PlotSpec> parse_plots(std::string_view list, std::vector<std::string>& trouble);

}  // namespace tactus::visual
