// A recorded or drawn motion: a CSV file with the header time_s,x_m,y_m,z_m[,qw,qx,qy,qz].
#pragma once

#include <Eigen/Geometry>
#include <iosfwd>
#include <string>
#include <vector>

namespace tactus::haptic {

struct Motion {
  std::vector<double> times_s;  // strictly increasing
  std::vector<Eigen::Vector3d> positions_m;
  std::vector<Eigen::Quaterniond>
      orientations;  // unit, neighbours in the same half space; identity when the file has none
};

// Accepts only a regular file of at most kMaxMotionFileBytes with lines of at most 1 kB, because another machine
// may name any path. Throws std::runtime_error with one sentence that names the file, the line and the remedy.
Motion read_motion(const std::string& path);
// The same from a stream; `name` appears in the error.
Motion read_motion(std::istream& in, const std::string& name);

}  // namespace tactus::haptic
