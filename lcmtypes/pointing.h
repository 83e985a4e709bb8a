// A tool that bears the name of a spot light points: the light shines at where the tool is, and the tool neither
// touches nor feels.
#pragma once

#include <algorithm>
#include <tactus/light_def_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <vector>

namespace tactus {

// Index of the light that the tool steers; -1: none, it is a tool that touches.
inline int steered_light(const tool_def_t& tool, const std::vector<light_def_t>& lights) {
  const auto light = std::find_if(lights.begin(), lights.end(), [&](const light_def_t& l) {
    return l.kind == light_def_t::SPOT && l.name == tool.name;
  });
  return light == lights.end() ? -1 : static_cast<int>(light - lights.begin());
}

}  // namespace tactus
