// Gains of loudspeakers for a source between them: vector base amplitude panning (Pulkki, "Virtual sound source
// positioning using vector base amplitude panning", J. Audio Eng. Soc. 45, 1997). Pure.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "audio_node/spatial/layout.h"

namespace tactus::audio {

// Loudspeakers at one height are used in pairs, without heights; others in threes, by the triangles of their
// convex hull. A source in a gap, for example behind a pair in front, is distributed over the rim of the gap.
class Panning {
 public:
  explicit Panning(const Layout& layout);

  int channels() const { return channels_; }
  // Gain of each channel, >= 0, with total power 1. Realtime-safe: yes.
  void gains(const Eigen::Vector3f& direction, float* of_channels) const;

 private:
  // Two or three loudspeakers and the matrix from a direction to their gains; the third of a pair is the height.
  struct Base {
    std::array<int, 3> speakers;
    Eigen::Matrix3f gains_of;
  };
  void build_pairs(std::vector<Eigen::Vector3d> level);
  void build_triangles(std::vector<Eigen::Vector3d> directions);

  int channels_;
  bool flat_ = false;
  std::vector<int> channel_of_;  // of each loudspeaker
  int real_ = 0;                 // number of real loudspeakers; virtual ones follow
  std::vector<std::vector<int>> rims_;
  std::vector<Base> bases_;
};

}  // namespace tactus::audio
