// Performance of string devices. For each frame, in the middle, over its workspace and beyond: the force available in every direction, the
// torque likewise, the resolution of the pose, and the time of a tick's computation.
#include <Eigen/SVD>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "haptic_node/devices/spidar/frame_file.h"
#include "haptic_node/devices/spidar/string_pose.h"
#include "haptic_node/devices/spidar/tensions.h"
#include "sync/node/node_options.h"

using namespace tactus::haptic;
using Eigen::Vector3d;
using nlohmann::json;

namespace {

// Spread evenly over the sphere (a spiral of golden angles), so that every run uses the same directions.
std::vector<Vector3d> directions(int count) {
  std::vector<Vector3d> out;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
    out.emplace_back(std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z);
  }
  return out;
}

// The force or torque in the least favourable direction; 0 where the strings do not hold the grip.
double guaranteed_N(const StringFrame& f, const GripPose& pose, bool torque, const std::vector<Vector3d>& samples) {
  constexpr double kHuge = 1000;  // N or N m: more than any motor here provides
  double min = kHuge;
  for (const Vector3d& direction : samples) {
    Wrench w;
    (torque ? w.torque_N_m : w.force_N) = kHuge * direction;
    const Tensions t = solve_tensions(f, pose, w);
    min = std::min(min, t.held ? t.share * kHuge : 0);
  }
  return min;
}

struct Row {
  double radius_m, tilt_rad, kept, force_N, torque_N_m, position_um, angle_mrad;
};

// Over poses at this distance from the middle, tilted by `tilt_rad` about axes of all directions.
Row row(const StringFrame& f, double radius_m, double tilt_rad) {
  const auto samples = directions(60), places = directions(radius_m > 0 ? 40 : 1),
             axes = directions(tilt_rad > 0 ? 12 : 1);
  Row r{radius_m, tilt_rad, 0, 1e9, 1e9, 0, 0};
  int poses = 0;
  for (const Vector3d& place : places) {
    for (const Vector3d& axis : axes) {
      const GripPose pose{radius_m * place, Eigen::Quaterniond(Eigen::AngleAxisd(tilt_rad, axis))};
      ++poses;
      if (!solve_tensions(f, pose, {}).held) {
        r.force_N = r.torque_N_m = 0;
        continue;
      }
      r.kept += 1;
      r.force_N = std::min(r.force_N, guaranteed_N(f, pose, false, samples));
      if (f.has_torque()) r.torque_N_m = std::min(r.torque_N_m, guaranteed_N(f, pose, true, samples));
      // Worst rounding of every string by half a count, to first order.
      const Eigen::MatrixXd back =
          Eigen::MatrixXd(structure_matrix(f, pose).transpose()).completeOrthogonalDecomposition().pseudoInverse();
      const double half = f.encoder_step_m / 2;
      r.position_um = std::max(r.position_um, 1e6 * half * back.topRows(3).cwiseAbs().rowwise().sum().norm());
      if (f.has_torque())
        r.angle_mrad = std::max(r.angle_mrad,
                                1e3 * half / f.lever_m() * back.bottomRows(3).cwiseAbs().rowwise().sum().norm());
    }
  }
  r.kept /= poses;
  return r;
}

double median_us(std::vector<double>& v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

// One tick: the pose from lengths one millimetre further, the tensions of a feasible force and of a clipped one.
json speeds(const StringFrame& f) {
  using Clock = std::chrono::steady_clock;
  const auto us = [](Clock::duration d) { return std::chrono::duration<double, std::micro>(d).count(); };
  std::vector<double> pose_us, given_us, cut_us;
  GripPose pose;
  for (const Vector3d& direction : directions(2000)) {
    const GripPose next{0.5 * f.workspace_radius_m * direction, {}};
    const PerString lengths = string_lengths(f, next);
    pose.position_m = next.position_m + Vector3d(0.001, 0, 0);
    auto start = Clock::now();
    pose = solve_pose(f, lengths, pose).pose;
    pose_us.push_back(us(Clock::now() - start));
    for (const double size : {0.5, 1000.0}) {
      start = Clock::now();
      const Tensions t = solve_tensions(f, pose, {size * direction, Vector3d::Zero()});
      (size < 1 ? given_us : cut_us).push_back(us(Clock::now() - start));
      if (t.share > 2) return {};  // never happens: prevents the optimiser from removing the call
    }
  }
  return {{"pose_us", median_us(pose_us)},
          {"tensions_us", median_us(given_us)},
          {"cut_tensions_us", median_us(cut_us)}};
}

json table_of(const StringFrame& f) {
  std::printf("\n%s: %d strings, %.1f to %.0f N each, %.1f um a count, workspace %.0f mm, %.0f degrees\n",
              f.name.c_str(), f.size(), f.min_tension_N, f.max_tension_N, 1e6 * f.encoder_step_m,
              1e3 * f.workspace_radius_m, f.workspace_tilt_rad * 180 / std::numbers::pi);
  std::printf("%10s %9s %7s %11s %12s %12s %10s\n", "radius mm", "tilt deg", "kept", "force N", "torque mN m",
              "position um", "angle mrad");
  json rows = json::array();
  std::vector<double> tilts = {0};
  if (f.has_torque()) tilts = {0, f.workspace_tilt_rad, 2 * f.workspace_tilt_rad};
  for (const double tilt : tilts) {
    for (const double share : {0.0, 0.5, 1.0, 1.5, 2.0}) {
      const Row r = row(f, share * f.workspace_radius_m, tilt);
      std::printf("%10.0f %9.0f %6.0f%% %11.2f %12.0f %12.1f %10.2f\n", 1e3 * r.radius_m,
                  r.tilt_rad * 180 / std::numbers::pi, 100 * r.kept, r.force_N,
                  f.has_torque() ? 1e3 * r.torque_N_m : 0, r.position_um, r.angle_mrad);
      rows.push_back({{"radius_m", r.radius_m},
                      {"tilt_rad", r.tilt_rad},
                      {"kept", r.kept},
                      {"force_N", r.force_N},
                      {"torque_N_m", f.has_torque() ? r.torque_N_m : 0},
                      {"position_um", r.position_um},
                      {"angle_mrad", r.angle_mrad}});
    }
  }
  const json s = speeds(f);
  std::printf("a tick, median: pose %.1f us, tensions %.1f us, of a force that is cut %.1f us\n",
              s["pose_us"].get<double>(), s["tensions_us"].get<double>(), s["cut_tensions_us"].get<double>());
  return {{"frame", f.name}, {"rows", rows}, {"speed", s}};
}

}  // namespace

int main(int argc, char** argv) try {
  tactus::sync::Arguments app("Forces that a string device can render, by position.");
  std::string out;
  std::vector<std::string> names = known_frames();
  app.add_option("--json", out, "file to write the figures to");
  app.add_option("frames", names, "known frames or JSON files; default: all known");
  tactus::sync::parse_or_exit(app, "spidar_table", argc, argv);
  json all = json::array();
  for (const std::string& name : names) {
    const auto known = known_frame(name);
    all.push_back(table_of(known ? *known : read_frame(name)));
  }
  if (!out.empty() && !(std::ofstream(out) << all.dump(1) << "\n"))
    throw std::runtime_error("cannot write " + out);
  return 0;
} catch (const std::exception& e) {
  std::cerr << "spidar_table: " << e.what() << "\n";
  return 1;
}
