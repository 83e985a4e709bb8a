// Measured head-related impulse responses from a SOFA file (AES69).
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

namespace tactus::audio {

struct MeasuredHrtf {
  double rate_Hz = 0;
  int samples = 0;                          // of one response
  std::vector<Eigen::Vector3d> directions;  // unit; x ahead, y to the left, z up
  std::vector<float> responses;             // of each direction: left ear, right ear
  std::vector<double> delays;               // before each of them, samples

  // ear: 0 left, 1 right.
  std::span<const float> response(std::size_t direction, std::size_t ear) const {
    const auto n = static_cast<std::size_t>(samples);
    return std::span(responses).subspan((2 * direction + ear) * n, n);
  }
  double delay(std::size_t direction, std::size_t ear) const { return delays[2 * direction + ear]; }
};

// Loads the directions at the largest distance in the file. Reads a file: do not call it in a loop or in the
// callback. Throws std::runtime_error with one sentence.
MeasuredHrtf load_sofa(const std::string& path);

}  // namespace tactus::audio
