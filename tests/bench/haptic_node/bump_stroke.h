// One stroke over planks.png, on a flat board that wears it as a map and on a fine mesh of the same relief: what
// the simulation says of the surface (ToolTouch) and what touch makes of it (haptic::Renderer), without clock or
// bus.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace tactus::bench {

struct BumpStroke {
  std::string method =
      "normal";  // of a board with a map: none, height, normal, both; "mesh": the relief in triangles
  double speed_m_s = 0.1, rate_Hz = 1000, height_m = 0.0005;
  double length_m = 0.4, oblique = 0.3;  // way along v, and how far it goes along u meanwhile, per metre
  double friction = 0;                   // of the pair
  double depth_m = 0.002;                // of the device under black; 1000 N/m
  double lateral_m = 0.0;                // u where it begins
};

// Of each tick between the ends.
struct BumpTrace {
  double step_m = 0;
  std::vector<double> place_m;  // along the stroke
  std::vector<double> along_N, up_N;
  std::vector<double> slope;     // of the map, along the stroke, where the device is
  std::vector<double> proxy_m;   // height of the proxy
  std::vector<double> change_N;  // of the force from tick to tick
};

BumpTrace run(const BumpStroke& stroke);

}  // namespace tactus::bench
