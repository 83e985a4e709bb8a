// One stroke over planks.png, on a flat board with the map and on a fine mesh of the same relief: the touch model of the simulation
// (ToolTouch) and its rendering (haptic::Renderer), without a clock or a bus.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace tactus::bench {

struct BumpStroke {
  std::string method =
      "normal";  // map methods of a board: none, height, normal, both; "mesh": the relief in triangles
  double speed_m_s = 0.1, rate_Hz = 1000, height_m = 0.0005;
  double length_m = 0.4, oblique = 0.3;  // length along v, and the way along u per metre
  double friction = 0;                   // friction of the pair of materials
  double depth_m = 0.002;                // of the device under the level of black; 1000 N/m
  double lateral_m = 0.0;                // u at the beginning
};

// Samples of each tick between the ends.
struct BumpTrace {
  double step_m = 0;
  std::vector<double> position_m;  // along the stroke
  std::vector<double> along_N, up_N;
  std::vector<double> slope;     // of the map, along the stroke, at the device
  std::vector<double> proxy_m;   // height of the proxy
  std::vector<double> change_N;  // change of the force per tick
  std::vector<double> rise_N;    // growth of the force per tick beyond the part of the last one along it
};

BumpTrace run(const BumpStroke& stroke);

}  // namespace tactus::bench
