// Measured head-related impulse responses from a SOFA file (AES69).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

struct MYSOFA_HRTF;

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

// Loads the directions at the largest distance in the file. The program read_sounds parses it, confined
// (sync/sandbox/reader_process.h): do not call it in a loop or in the callback. Throws std::runtime_error with one
// sentence.
MeasuredHrtf load_sofa(const std::string& path);

// The same in this process. Throws std::runtime_error with the end of the sentence: "has no Data.Delay ...".
MeasuredHrtf parse_sofa(const std::string& path);

// Whether the arrays of a parsed file are as long as its dimensions say; empty: they are, else the end of a sentence. For
// a file that libmysofa has not checked yet.
std::string array_fault(const MYSOFA_HRTF& file);

// Between the two processes. unpack_hrtf throws std::runtime_error with one clause.
std::vector<std::uint8_t> pack(const MeasuredHrtf& measured);
MeasuredHrtf unpack_hrtf(std::span<const std::uint8_t> bytes);

}  // namespace tactus::audio
