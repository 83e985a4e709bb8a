#include "visual_node/overlay/plot_spec.h"

#include <charconv>
#include <stdexcept>

#include "lcmtypes/spelling_suggestions.h"
#include "sync/bus/identity.h"
#include "sync/text/printable.h"

namespace tactus::visual {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\n");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\n") - begin + 1);
}

[[noreturn]] void reject(std::string_view text, const std::string& why) {
  throw std::invalid_argument("plot \"" + sync::printable(std::string(text.substr(0, 80))) + "\": " + why);
}

PlotSpec::Kind kind_of(std::string_view word, std::string_view text) {
  if (word == "graph") return PlotSpec::Kind::kGraph;
  if (word == "bar") return PlotSpec::Kind::kBar;
  if (word == "text") return PlotSpec::Kind::kText;
  reject(text, "begin it with graph, bar or text");
}

const MessageType& type_of(std::string_view channel, std::string_view text) {
  if (const MessageType* type = type_on(channel)) return *type;
  std::vector<std::string> names;
  for (const Channel& c : channel_types()) names.emplace_back(c.name);
  reject(text, "there is no channel \"" + sync::printable(std::string(channel.substr(0, 40))) +
                   "\"; nearest: " + spelling_suggestions(channel, names));
}

void add_filter(PlotSpec& spec, const MessageType& type, std::string_view filter, std::string_view text) {
  const std::size_t equals = filter.find('=');
  if (filter.empty()) reject(text, "write a process or field=number after @");
  if (equals == std::string_view::npos) {
    // Every message of a channel begins with its header.
    spec.conditions.emplace_back(FieldPath(type, "header.source"),
                                 static_cast<std::int32_t>(sync::fnv1a_32(filter)));
    return;
  }
  const std::string_view number = filter.substr(equals + 1);
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc{} || end != number.data() + number.size())
    reject(text, "\"" + sync::printable(std::string(number.substr(0, 40))) + "\" is not a number");
  spec.conditions.emplace_back(FieldPath(type, filter.substr(0, equals)), value);
}

}  // namespace

std::optional<std::variant<double, std::string>> PlotSpec::read(std::span<const std::uint8_t> bytes) const {
  for (const auto& [path, wanted] : conditions)
    if (path.number(bytes) != wanted) return std::nullopt;
  return value.read(bytes);
}

PlotSpec parse_plot(std::string_view text) {
  text = trimmed(text);
  const std::size_t space = text.find_first_of(" \t");
  const PlotSpec::Kind kind = kind_of(text.substr(0, space), text);
  std::string_view rest = space == std::string_view::npos ? std::string_view{} : trimmed(text.substr(space));
  const std::string title(rest);
  std::vector<std::string_view> filters;
  for (std::size_t at = rest.rfind('@'); at != std::string_view::npos; at = rest.rfind('@')) {
    filters.push_back(rest.substr(at + 1));
    rest = rest.substr(0, at);
  }
  const std::size_t dot = rest.find('.');
  const std::string_view channel = rest.substr(0, dot);
  const MessageType& type = type_of(channel, text);
  try {
    PlotSpec spec{kind,
                  std::string(channel),
                  FieldPath(type, dot == std::string_view::npos ? "" : rest.substr(dot + 1)),
                  {},
                  title};
    if (spec.value.is_text() && kind != PlotSpec::Kind::kText)
      reject(text, "this field is text, not a number; use the kind text");
    for (const std::string_view filter : filters) add_filter(spec, type, filter, text);
    return spec;
  } catch (const std::invalid_argument& e) {
    if (std::string_view(e.what()).starts_with("plot \"")) throw;
    reject(text, e.what());
  }
}

std::vector<PlotSpec> parse_plots(std::string_view list, std::vector<std::string>& warnings) {
  std::vector<PlotSpec> specs;
  while (!list.empty()) {
    const std::size_t end = list.find(';');
    const std::string_view one = trimmed(list.substr(0, end));
    list = end == std::string_view::npos ? std::string_view{} : list.substr(end + 1);
    if (one.empty() || one == "none") continue;
    if (specs.size() == kMaxPlots) {
      warnings.push_back("more than " + std::to_string(kMaxPlots) + " plots: the rest is ignored");
      break;
    }
    try {
      specs.push_back(parse_plot(one));
    } catch (const std::invalid_argument& e) {
      warnings.emplace_back(e.what());
    }
  }
  return specs;
}

}  // namespace tactus::visual
