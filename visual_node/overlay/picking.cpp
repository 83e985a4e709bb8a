#include "visual_node/overlay/picking.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "lcmtypes/vectors.h"

namespace tactus::visual {
namespace {

struct Ray {
  Eigen::Vector3f from, along;
};

// Möller and Trumbore 1997: distance to the triangle in units of `along`; infinite: beside the ray or behind its
// origin.
float distance(const Ray& ray, const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  constexpr float kMiss = std::numeric_limits<float>::infinity();
  const Eigen::Vector3f ab = b - a, ac = c - a, p = ray.along.cross(ac);
  const float det = ab.dot(p);
  if (std::abs(det) < 1e-20f) return kMiss;
  const Eigen::Vector3f s = (ray.from - a) / det;
  const float u = s.dot(p);
  if (u < 0 || u > 1) return kMiss;
  const Eigen::Vector3f q = s.cross(ab);
  const float v = ray.along.dot(q);
  if (v < 0 || u + v > 1) return kMiss;
  const float t = ac.dot(q);
  return t > 0 ? t : kMiss;
}

// Radius of the bounding sphere about the origin of its frame.
float radius_of(const Triangles& t) {
  float squared = 0;
  for (const Eigen::Vector3f& p : t.positions) squared = std::max(squared, p.squaredNorm());
  return std::sqrt(squared);
}

bool misses(const Ray& ray, float radius) {
  return ray.from.cross(ray.along).squaredNorm() > radius * radius * ray.along.squaredNorm();
}

// The ray in the frame of the shape, where distances in units of `along` stay the same.
Ray in_shape(const Ray& ray, const Instance& i) {
  const Eigen::Quaternionf world_shape(i.orientation);
  const Eigen::Vector3f scale = i.scale.head<3>();
  return {(world_shape.conjugate() * (ray.from - i.position.head<3>())).cwiseQuotient(scale),
          (world_shape.conjugate() * ray.along).cwiseQuotient(scale)};
}

std::optional<Ray> ray_at(const DrawList& list, float x, float y) {
  std::vector<View> views = list.views;
  if (views.empty()) views.push_back({.camera = list.camera});
  for (const View& v : views) {
    const float across = (x - v.x) / v.width, up = (1 - y - v.y) / v.height;
    if (!(across >= 0 && across <= 1 && up >= 0 && up <= 1)) continue;
    const Eigen::Matrix4f world_clip = v.camera.clip_from_world().inverse();
    const auto point = [&](float depth) -> Eigen::Vector3f {
      return (world_clip * Eigen::Vector4f(2 * across - 1, 2 * up - 1, depth, 1)).hnormalized();
    };
    const Eigen::Vector3f near = point(-1), along = (point(0) - near).normalized();
    if (near.allFinite() && along.allFinite()) return Ray{near, along};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Eigen::Vector3d> pick_surface(const DrawList& list, std::span<const Triangles> geometries, float x,
                                            float y) {
  const auto ray = ray_at(list, x, y);
  if (!ray) return std::nullopt;
  float nearest = std::numeric_limits<float>::infinity();
  std::map<int, float> radii;  // cache of the geometries in use: the ray misses most of thousands of balls
  for (const Batch& batch : list.opaque) {
    if (batch.geometry < 0 || static_cast<std::size_t>(batch.geometry) >= geometries.size()) continue;
    const Triangles& t = geometries[static_cast<std::size_t>(batch.geometry)];
    const auto [radius, fresh] = radii.try_emplace(batch.geometry, 0.0f);
    if (fresh) radius->second = radius_of(t);
    for (int i = batch.first; i < batch.first + batch.count; ++i) {
      const Ray own = in_shape(*ray, list.instances[static_cast<std::size_t>(i)]);
      if (misses(own, radius->second)) continue;
      for (std::size_t k = 0; k + 2 < t.indices.size(); k += 3)
        nearest = std::min(nearest, distance(own, t.positions[t.indices[k]], t.positions[t.indices[k + 1]],
                                             t.positions[t.indices[k + 2]]));
    }
  }
  if (!std::isfinite(nearest)) return std::nullopt;
  return list.camera.origin_m + (ray->from + nearest * ray->along).cast<double>();
}

std::optional<device_state_t> MousePointer::state(sync::HostTime now) {
  if (!target_) return std::nullopt;
  const bool first = !last_;
  const double dt_s = first ? 0 : std::clamp(sync::to_seconds(now - *last_), 0.0, 0.1);
  last_ = now;
  const Eigen::Vector3d before = at_, remaining = *target_ - at_;
  const double max_step_m = kMaxSpeed_m_s * dt_s;
  at_ = first || remaining.norm() <= max_step_m ? *target_
                                                : Eigen::Vector3d(at_ + remaining.normalized() * max_step_m);
  device_state_t m{};
  m.header.sim_time_ns = -1;
  m.device = kMouseDevice;
  m.pose = to_pose(Eigen::Isometry3d(Eigen::Translation3d(at_)));
  if (!first && dt_s > 0) m.velocity_m_s = to_vec3f(Eigen::Vector3d((at_ - before) / dt_s));
  m.state = device_state_t::ANSWERS;
  return m;
}

}  // namespace tactus::visual
