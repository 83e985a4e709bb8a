#include "sync/text/settings.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace tactus::sync {
namespace {

struct Unit {
  std::string_view written, base;
  double factor;
};
// Common SI prefixes of these quantities, and degrees.
constexpr std::array kUnits{
    Unit{"ns", "s", 1e-9},   Unit{"us", "s", 1e-6},     Unit{"ms", "s", 1e-3},      Unit{"min", "s", 60},
    Unit{"kHz", "Hz", 1e3},  Unit{"mm", "m", 1e-3},     Unit{"cm", "m", 1e-2},      Unit{"um", "m", 1e-6},
    Unit{"mN", "N", 1e-3},   Unit{"N/mm", "N/m", 1e3},  Unit{"kN/m", "N/m", 1e3},   Unit{"mJ", "J", 1e-3},
    Unit{"g", "kg", 1e-3},   Unit{"mm/s", "m/s", 1e-3}, Unit{"cm/s", "m/s", 1e-2},  Unit{"deg", "rad", std::numbers::pi / 180},
    Unit{"kPa", "Pa", 1e3},  Unit{"MPa", "Pa", 1e6},    Unit{"GPa", "Pa", 1e9},     Unit{"%", "1", 1e-2},
    Unit{"ppm", "1", 1e-6},
    Unit{"mW", "W", 1e-3},   Unit{"cm2", "m2", 1e-4},   Unit{"mm2", "m2", 1e-6},
};

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && s.front() == ' ') s.remove_prefix(1);
  while (!s.empty() && s.back() == ' ') s.remove_suffix(1);
  return s;
}

// Without trailing zeros, and without a unit for dimensionless values.
std::string number_text(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", number);
  return text;
}
std::string unit_text(std::string_view unit) { return unit == "1" || unit == "count" ? "" : " " + std::string(unit); }

std::string sentence_begin(const SettingRow& row, std::string_view value) {
  return "setting \"" + std::string(row.name) + "\" = \"" + std::string(value) + "\": ";
}

bool is_choice(std::string_view unit) { return unit.find('|') != std::string_view::npos; }

}  // namespace

double parse_quantity(std::string_view text, std::string_view unit) {
  text = trimmed(text);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || !std::isfinite(number))
    throw std::invalid_argument("\"" + std::string(text) + "\" is not a number" + (unit == "1" ? "" : " in " + std::string(unit)));
  const std::string_view written = trimmed(text.substr(static_cast<std::size_t>(end - text.data())));
  if (written.empty() || written == unit) return number;
  for (const Unit& u : kUnits)
    if (u.written == written && u.base == unit) return number * u.factor;
  throw std::invalid_argument("\"" + std::string(written) + "\" is not a unit of " + (unit == "1" ? "a plain number" : std::string(unit)));
}

void check_setting(const SettingRow& row, std::string_view value) {
  const std::string prefix = sentence_begin(row, value);
  const std::string_view unit = row.unit;
  if (unit == "text") return;
  if (unit == "bool") {
    if (value != "true" && value != "false" && value != "1" && value != "0")
      throw std::invalid_argument(prefix + "must be true or false");
    return;
  }
  if (is_choice(unit)) {
    std::string_view rest = unit;
    while (!rest.empty()) {
      const auto bar = rest.find('|');
      const std::string_view word = rest.substr(0, bar);
      if (word == value || (word.ends_with('*') && value.size() >= word.size() && value.starts_with(word.substr(0, word.size() - 1)))) return;
      rest = bar == std::string_view::npos ? "" : rest.substr(bar + 1);
    }
    throw std::invalid_argument(prefix + "must be one of " + std::string(unit));
  }
  double number = 0;
  try {
    number = parse_quantity(value, unit == "count" ? "1" : unit);
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(prefix + e.what());
  }
  if (number < row.min || number > row.max || (unit == "count" && number != std::floor(number)))
    throw std::invalid_argument(prefix + "must be between " + number_text(row.min) + " and " + number_text(row.max) +
                                unit_text(unit) + (unit == "count" ? ", whole" : ""));
}

void check_scene_setting(const SettingRow& row, std::string_view value) {
  check_setting(row, value);
  const std::string_view safety = row.safety, unit = row.unit;
  if (safety.empty()) return;
  const std::string_view base = unit == "count" ? "1" : unit;
  const double wanted = parse_quantity(value, base), limit = parse_quantity(row.initial, base);
  if (safety == "max" ? wanted <= limit : wanted >= limit) return;
  throw std::invalid_argument(sentence_begin(row, value) + "a scene or `tactus set` may only tighten this safety limit, to " +
                              number_text(limit) + unit_text(unit) + (safety == "max" ? " or less" : " or more") +
                              "; loosen it with --set on the node's own command line");
}

}  // namespace tactus::sync
