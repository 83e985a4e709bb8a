// Owning handles of ODE objects. Only files named ode_*.cpp include this.
#pragma once

#include <ode/ode.h>

#include <Eigen/Geometry>
#include <memory>
#include <type_traits>

namespace tactus::sim::ode {

struct Destroy {
  void operator()(dWorldID w) const { dWorldDestroy(w); }
  void operator()(dSpaceID s) const { dSpaceDestroy(s); }
  void operator()(dTriMeshDataID d) const { dGeomTriMeshDataDestroy(d); }
  void operator()(dHeightfieldDataID d) const { dGeomHeightfieldDataDestroy(d); }
};
template <class Id>
using Owned = std::unique_ptr<std::remove_pointer_t<Id>, Destroy>;

// ODE's global state, reference-counted, so that several worlds can exist in one process. One thread only: ODE's
// random numbers and message handler are global.
class Library {
 public:
  Library();
  ~Library();
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

inline Eigen::Vector3d to_eigen(const dReal* v) { return {v[0], v[1], v[2]}; }
inline Eigen::Quaterniond quaternion(const dReal* q) { return {q[0], q[1], q[2], q[3]}; }
inline void set_quaternion(const Eigen::Quaterniond& q, dQuaternion out) {
  out[0] = q.w(), out[1] = q.x(), out[2] = q.y(), out[3] = q.z();
}

}  // namespace tactus::sim::ode
