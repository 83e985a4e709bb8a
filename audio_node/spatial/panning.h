// How strongly each loudspeaker sounds, so that a source is heard from between them: vector base amplitude panning
// (Pulkki, "Virtual sound source positioning using vector base amplitude panning", J. Audio Eng. Soc. 45, 1997).
// Pure.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "audio_node/spatial/layout.h"

namespace tactus::audio {

// Loudspeakers at one height are taken two by two and hear no heights; others three by three, by the triangles of
// their convex hull. Where they leave a gap, as behind a pair in front, a source is given to those at its rim.
class Panning {
 public:
  explicit Panning(const Layout& layout);

  int channels() const { return channels_; }
  // Of each channel, none negative, of power 1 together. Realtime-safe: yes.
  void gains(const Eigen::Vector3f& direction, float* of_channels) const;

 private:
  // Two or three loudspeakers and what makes of a direction their gains; the third of a pair is the height.
  struct Base {
    std::array<int, 3> speakers;
    Eigen::Matrix3f gains_of;
  };
  void take_pairs(std::vector<Eigen::Vector3d> level);
  void take_triangles(std::vector<Eigen::Vector3d> directions);

  int channels_;
  bool flat_ = false;
  std::vector<int> channel_of_;  // of each loudspeaker
  int real_ = 0;                 // loudspeakers; what comes after them stands in a gap
  std::vector<std::vector<int>> rims_;
  std::vector<Base> bases_;
};

}  // namespace tactus::audio
