#include "sim_node/model/measured_modes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>

#include "lcmtypes/measured_modes.h"
#include "sync/text/settings.h"

namespace tactus::sim {
namespace {

std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',')
      cells.emplace_back();
    else if (c != '\r')
      cells.back() += c;
  }
  return cells;
}

std::map<std::string, std::size_t> columns_of(std::string_view line) {
  std::map<std::string, std::size_t> columns;
  for (const std::string& name : cells_of(line)) columns.try_emplace(name, columns.size());
  for (const char* needed : {"frequency_Hz", "damping_1_s", "amplitude"})
    if (!columns.contains(needed)) throw std::runtime_error(std::string("column ") + needed + " is missing");
  return columns;
}

measured_mode_t mode_of(const std::vector<std::string>& cells, const std::map<std::string, std::size_t>& columns) {
  const auto property = [&](const std::string& column, const std::string& unit) {
    const std::size_t at = columns.at(column);
    if (at >= cells.size()) throw std::runtime_error(column + " is missing");
    try {
      return sync::parse_quantity(cells[at], unit);
    } catch (const std::invalid_argument& e) {
      throw std::runtime_error(column + ": " + e.what());
    }
  };
  measured_mode_t mode{};
  mode.frequency_Hz = property("frequency_Hz", "Hz");
  mode.damping_1_s = property("damping_1_s", "1/s");
  mode.amplitude = property("amplitude", "1");
  if (!(mode.frequency_Hz >= kMinModeFrequency_Hz && mode.frequency_Hz <= kMaxModeFrequency_Hz))
    throw std::runtime_error("frequency_Hz is not between 20 and 20000");
  if (!(mode.damping_1_s > 0 && mode.damping_1_s < 2 * std::numbers::pi * mode.frequency_Hz))
    throw std::runtime_error("damping_1_s is not above 0 and below critical damping");
  if (!(mode.amplitude > 0 && std::isfinite(mode.amplitude))) throw std::runtime_error("amplitude is not above 0");
  return mode;
}

}  // namespace

std::vector<measured_mode_t> parse_measured_modes(std::string_view csv) {
  std::map<std::string, std::size_t> columns;
  std::vector<measured_mode_t> modes;
  for (int row = 1; !csv.empty(); ++row) {
    const auto end = csv.find('\n');
    const std::string_view line = csv.substr(0, end);
    csv.remove_prefix(end == std::string_view::npos ? csv.size() : end + 1);
    if (line.empty() || line == "\r") continue;
    try {
      if (columns.empty())
        columns = columns_of(line);
      else
        modes.push_back(mode_of(cells_of(line), columns));
    } catch (const std::runtime_error& e) {
      throw std::runtime_error("row " + std::to_string(row) + ": " + e.what());
    }
    if (modes.size() > static_cast<std::size_t>(kMaxMeasuredModes))
      throw std::runtime_error("it has more than " + std::to_string(kMaxMeasuredModes) + " modes");
  }
  if (modes.empty()) throw std::runtime_error("it has no modes");
  std::sort(modes.begin(), modes.end(),
            [](const measured_mode_t& a, const measured_mode_t& b) { return a.frequency_Hz < b.frequency_Hz; });
  return modes;
}

}  // namespace tactus::sim
