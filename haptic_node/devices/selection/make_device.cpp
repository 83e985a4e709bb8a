#include "haptic_node/devices/selection/make_device.h"

#include <stdexcept>
#include <tactus/waypoint_t.hpp>

#include "haptic_node/devices/external.h"
#include "haptic_node/devices/spidar/frame_file.h"
#include "haptic_node/devices/spidar/simulated_strings.h"
#include "haptic_node/devices/spidar/spidar.h"
#include "haptic_node/devices/virtual_hand.h"
#include "lcmtypes/vectors.h"

namespace tactus::haptic {
namespace {

// Adds the way back to the first point, so that a repeated path does not jump.
void close_path(std::vector<double>& times, std::vector<Eigen::Vector3d>& points, double speed_m_s) {
  const double distance = (points.front() - points.back()).norm();
  if (distance == 0) return;
  times.push_back(times.back() + distance / speed_m_s);
  points.push_back(points.front());
}

std::unique_ptr<Device> make_hand(const DeviceSpec& spec, const tool_def_t& tool, const Eigen::Vector3d& rest_m,
                                  const Settings& s, const Eigen::Quaterniond& rest) {
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
      HandImpedance{s.hand_mass_kg, s.hand_damping_Ns_m, s.hand_stiffness_N_m, s.hand_inertia_kgm2,
                    s.hand_turn_damping_Nms_rad, s.hand_turn_stiffness_Nm_rad},
      rest);
}

StringFrame frame_of(const DeviceSpec& spec) {
  if (!spec.file.empty()) return read_frame(spec.file);
  if (auto frame = known_frame(spec.name)) return *std::move(frame);
  std::string known;
  for (const std::string& name : known_frames()) known += (known.empty() ? "" : ", ") + name;
  throw std::runtime_error("device \"spidar:" + spec.name + "\": there is no such frame; use one of " + known +
                           " or a JSON file");
}

}  // namespace

DeviceSpec parse_device_spec(const std::string& spec) {
  DeviceSpec out{parse_tool_device(spec), {}, {}};
  if (out.kind == DeviceSpec::Kind::kSpidar)
    out.frame = frame_of(out);
  else if (!out.file.empty())
    out.motion = read_motion(out.file);
  return out;
}

std::unique_ptr<Device> make_device(const DeviceSpec& spec, const tool_def_t& tool, const Eigen::Vector3d& rest_m,
                                    const Settings& settings, const Eigen::Quaterniond& rest) {
  if (spec.kind == DeviceSpec::Kind::kPlayback) return std::make_unique<Playback>(*spec.motion, spec.placement);
  if (spec.kind == DeviceSpec::Kind::kExternal)
    return std::make_unique<External>(
        spec.name, spec.placement.offset_m,
        ExternalDef{settings.device_stale_after_s, settings.device_delay_s, settings.device_output == "at_once"});
  auto hand = make_hand(spec, tool, rest_m, settings, rest);
  if (spec.kind == DeviceSpec::Kind::kVirtualHand) return hand;
  const Eigen::Vector3d& origin_m = spec.placement.offset_m;
  return std::make_unique<Spidar>(*spec.frame, origin_m,
                                  std::make_unique<SimulatedStrings>(*spec.frame, origin_m, std::move(hand)));
}

}  // namespace tactus::haptic
