// Cost per step of the touch model of a tool with a shape: over bumps, in a bowl, in a hole, and in the corner of three meshes.
#pragma once

#include <functional>
#include <string>

namespace tactus::sim::test {

struct ShapeRow {
  std::string scene, tool;
  double speed_m_s = 0;  // speed that the device reports: the margin of the model grows with it
  double triangles = 0;  // mean number of scene triangles that meet the ball around the tool with its margin
  double planes = 0;     // mean number of planes
  double median_us = 0, p99_us = 0;
};

// scenes: the folder of the scenes' own meshes. only: text that "scene tool" must contain. done: receives each row when it is complete.
// The tool touches in every step.
void shape_rows(const std::string& scenes, int steps, const std::string& only,
                const std::function<void(const ShapeRow&)>& done);

}  // namespace tactus::sim::test
