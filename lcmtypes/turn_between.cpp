#include "lcmtypes/turn_between.h"

namespace tactus {

Eigen::Quaterniond turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) { return Eigen::Quaterniond::FromTwoVectors(from, to); }

}  // namespace tactus
