#include "lcmtypes/tool_device.h"

#include <charconv>
#include <cmath>
#include <string_view>

namespace tactus {
namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& what) {
  throw BadDevice("device \"" + text + "\": " + what);
}

double number(std::string_view word, const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value))
    refuse(text, '"' + std::string(word) + "\" is not a number");
  return value;
}

Eigen::Vector3d triple(std::string_view word, const std::string& text) {
  const auto first = word.find('/'), last = word.rfind('/');
  if (first == std::string_view::npos || first == last) refuse(text, "write the offset as offset=X/Y/Z in metres");
  return {number(word.substr(0, first), text), number(word.substr(first + 1, last - first - 1), text),
          number(word.substr(last + 1), text)};
}

constexpr const char* kForms =
    "virtual_hand, virtual_hand:FILE, playback:FILE[,scale=S][,offset=X/Y/Z][,rate=R], "
    "spidar:NAME|FILE.json[,offset=X/Y/Z] or external:NAME[,offset=X/Y/Z]";

void set_option(ToolDevice& device, std::string_view option, const std::string& text) {
  const bool playback = device.kind == ToolDevice::Kind::kPlayback;
  Placement& placement = device.placement;
  const auto equals = option.find('=');
  const std::string_view name = option.substr(0, equals);
  const std::string_view value = equals == std::string_view::npos ? "" : option.substr(equals + 1);
  if (name == "scale" && playback) {
    placement.scale = number(value, text);
  } else if (name == "offset") {
    placement.offset_m = triple(value, text);
  } else if (name == "rate" && playback) {
    placement.rate = number(value, text);
    if (placement.rate <= 0) refuse(text, "rate must be above 0");
  } else {
    refuse(text, "there is no option \"" + std::string(name) + "\"; there " +
                     (playback ? "are scale, offset and rate" : "is offset"));
  }
}

}  // namespace

ToolDevice parse_tool_device(const std::string& text) {
  using Kind = ToolDevice::Kind;
  const auto colon = text.find(':');
  const std::string kind = text.substr(0, colon);
  ToolDevice out;
  if (kind == "playback")
    out.kind = Kind::kPlayback;
  else if (kind == "spidar")
    out.kind = Kind::kSpidar;
  else if (kind == "external")
    out.kind = Kind::kExternal;
  else if (kind != "virtual_hand")
    refuse(text, std::string("unknown; use ") + kForms);
  if (colon == std::string::npos) {
    if (out.kind == Kind::kPlayback) refuse(text, "name the file to play: playback:FILE");
    if (out.kind == Kind::kSpidar) refuse(text, "name the frame: spidar:desktop, or a JSON file");
    if (out.kind == Kind::kExternal) refuse(text, "give the name of its driver: external:NAME");
    return out;
  }
  std::string_view rest = std::string_view(text).substr(colon + 1);
  auto comma = rest.find(',');
  const std::string what(rest.substr(0, comma));
  if (what.empty()) refuse(text, "name a file after the colon");
  const bool named = out.kind == Kind::kExternal || (out.kind == Kind::kSpidar && !what.ends_with(".json"));
  (named ? out.name : out.file) = what;
  while (comma != std::string_view::npos) {
    if (out.kind == Kind::kVirtualHand) refuse(text, "virtual_hand takes no options after its file");
    rest.remove_prefix(comma + 1);
    comma = rest.find(',');
    set_option(out, rest.substr(0, comma), text);
  }
  return out;
}

std::string with_device_file(const std::string& text, const std::string& file) {
  if (file.find(',') != std::string::npos)
    refuse(text, "the path " + file + " has a comma, which begins the options");
  const auto colon = text.find(':'), comma = text.find(',');
  return text.substr(0, colon + 1) + file + (comma == std::string::npos ? "" : text.substr(comma));
}

}  // namespace tactus
