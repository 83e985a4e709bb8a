#include "haptic_node/devices/make_device.h"

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "haptic_node/devices/virtual_hand.h"
#include "lcmtypes/vectors.h"

namespace tactus::haptic {
namespace {

[[noreturn]] void refuse(const std::string& spec, const std::string& what) {
  throw std::runtime_error("device \"" + spec + "\": " + what);
}

double number(std::string_view text, const std::string& spec) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    refuse(spec, "\"" + std::string(text) + "\" is no number");
  return value;
}

Eigen::Vector3d triple(std::string_view text, const std::string& spec) {
  const auto first = text.find('/'), last = text.rfind('/');
  if (first == std::string_view::npos || first == last) refuse(spec, "write the offset as offset=X/Y/Z in metres");
  return {number(text.substr(0, first), spec), number(text.substr(first + 1, last - first - 1), spec),
          number(text.substr(last + 1), spec)};
}

void set_option(Placement& placement, std::string_view option, const std::string& spec) {
  const auto equals = option.find('=');
  const std::string_view name = option.substr(0, equals);
  const std::string_view value = equals == std::string_view::npos ? "" : option.substr(equals + 1);
  if (name == "scale") {
    placement.scale = number(value, spec);
  } else if (name == "offset") {
    placement.offset_m = triple(value, spec);
  } else if (name == "rate") {
    placement.rate = number(value, spec);
    if (placement.rate <= 0) refuse(spec, "rate must be above 0");
  } else {
    refuse(spec, "there is no option \"" + std::string(name) + "\"; there are scale, offset and rate");
  }
}

// The way back to the first point, so that a path that repeats does not jump.
void close_path(std::vector<double>& times, std::vector<Eigen::Vector3d>& points, double speed_m_s) {
  const double distance = (points.front() - points.back()).norm();
  if (distance == 0) return;
  times.push_back(times.back() + distance / speed_m_s);
  points.push_back(points.front());
}

std::unique_ptr<Device> make_hand(const DeviceSpec& spec, const tool_def_t& tool, const Eigen::Vector3d& rest_m,
                                  const Settings& s) {
  std::vector<double> times;
  std::vector<Eigen::Vector3d> points;
  if (spec.motion) {
    times = spec.motion->times_s;
    points = spec.motion->positions_m;
  } else {
    for (const waypoint_t& w : tool.waypoints) {
      if (!times.empty() && w.time_s <= times.back())
        throw std::runtime_error("tool \"" + tool.name +
                                 "\": the times of its waypoints do not increase; sort them");
      times.push_back(w.time_s);
      points.push_back(to_eigen(w.position_m));
    }
  }
  if (times.empty()) {
    times = {0};
    points = {rest_m};
  }
  const bool loop = tool.loop != 0 && times.size() > 1;
  if (loop) close_path(times, points, s.path_return_speed_m_s);
  return std::make_unique<VirtualHand>(
      MonotoneCubic(std::move(times), std::move(points), MonotoneCubic::Ends::kRest), loop,
      HandImpedance{s.hand_mass_kg, s.hand_damping_Ns_m, s.hand_stiffness_N_m});
}

}  // namespace

DeviceSpec parse_device_spec(const std::string& spec) {
  const auto colon = spec.find(':');
  const std::string kind = spec.substr(0, colon);
  if (kind != "virtual_hand" && kind != "playback")
    refuse(spec,
           "unknown; use virtual_hand, virtual_hand:FILE or playback:FILE[,scale=S][,offset=X/Y/Z][,rate=R]");
  DeviceSpec out;
  out.kind = kind == "playback" ? DeviceSpec::Kind::kPlayback : DeviceSpec::Kind::kVirtualHand;
  if (colon == std::string::npos) {
    if (out.kind == DeviceSpec::Kind::kPlayback) refuse(spec, "name the file to play: playback:FILE");
    return out;
  }
  std::string_view rest = std::string_view(spec).substr(colon + 1);
  auto comma = rest.find(',');
  const std::string file(rest.substr(0, comma));
  if (file.empty()) refuse(spec, "name a file after the colon");
  while (comma != std::string_view::npos) {
    if (out.kind == DeviceSpec::Kind::kVirtualHand) refuse(spec, "virtual_hand takes no options after its file");
    rest.remove_prefix(comma + 1);
    comma = rest.find(',');
    set_option(out.placement, rest.substr(0, comma), spec);
  }
  out.motion = read_motion(file);
  return out;
}

std::unique_ptr<Device> make_device(const DeviceSpec& spec, const tool_def_t& tool, const Eigen::Vector3d& rest_m,
                                    const Settings& settings) {
  if (spec.kind == DeviceSpec::Kind::kPlayback) return std::make_unique<Playback>(*spec.motion, spec.placement);
  return make_hand(spec, tool, rest_m, settings);
}

}  // namespace tactus::haptic
