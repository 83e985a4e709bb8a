// Reference values of pixels, from the published formulas in double precision. Shares no code with shaders/ and
// takes lamps and materials from the message.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <tactus/light_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/visual_def_t.hpp>
#include <utility>
#include <vector>

#include "lcmtypes/vectors.h"
#include "tests/visual_node/support/offscreen.h"

namespace tactus::test::reference {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

// Properties of a point of a surface.
struct Point {
  Vector3d at = Vector3d::Zero(), normal = Vector3d::UnitZ();
  Vector3d tangent = Vector3d::UnitX();
  double binormal_sign = 1;
  Vector2d uv = Vector2d::Zero();
};

// The hit of the eye's ray, with the three corners of the triangle and their weights.
struct Hit {
  Point point;
  std::array<Point, 3> corners;
  Vector3d shares = Vector3d::Zero();
  double distance_m = std::numeric_limits<double>::infinity();
};

// IEC 61966-2-1, of 0 .. 255.
inline double linear(double encoded) {
  const double e = encoded / 255;
  return e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4);
}

// The ray through the middle of a pixel: x from the left, y from the top.
inline Vector3d ray(const scene_t& scene, double x, double y) {
  const double focal_px = kWidth / 2 / std::tan(scene.camera_fov_rad / 2);
  const Vector3d along(1, -(x + 0.5 - kWidth / 2) / focal_px, -(y + 0.5 - kHeight / 2) / focal_px);
  return (to_eigen(scene.camera).linear() * along).normalized();
}

// The triangles of one instance in the world, computed once for all rays.
struct PlacedTriangles {
  std::vector<std::array<Point, 3>> corners;
  bool two_sided = false;

  PlacedTriangles(const visual::Triangles& t, const visual::Instance& instance) : two_sided(t.two_sided) {
    const Eigen::Quaterniond q(Eigen::Quaternionf(instance.orientation).cast<double>());
    const Vector3d origin = instance.position.head<3>().cast<double>(),
                   scale = instance.scale.head<3>().cast<double>();
    const auto corner = [&](std::size_t i) {
      Point p;
      p.at = origin + q * Vector3d(t.positions[i].cast<double>().cwiseProduct(scale));
      p.normal = q * t.normals[i].cast<double>();
      if (!t.texcoords.empty()) p.uv = t.texcoords[i].cast<double>();
      if (!t.tangents.empty()) {
        p.tangent = q * Vector3d(t.tangents[i].head<3>().cast<double>().cwiseProduct(scale));
        p.binormal_sign = static_cast<double>(t.tangents[i].w());
      }
      return p;
    };
    for (std::size_t i = 0; i + 2 < t.indices.size(); i += 3)
      corners.push_back({corner(t.indices[i]), corner(t.indices[i + 1]), corner(t.indices[i + 2])});
  }
};

// Attributes are interpolated here as the device does (Moeller and Trumbore 1997).
inline std::optional<Hit> meet(const PlacedTriangles& t, const Vector3d& eye, const Vector3d& along) {
  std::optional<Hit> nearest;
  for (const std::array<Point, 3>& c : t.corners) {
    const Vector3d e1 = c[1].at - c[0].at, e2 = c[2].at - c[0].at, p = along.cross(e2);
    const double det = e1.dot(p);
    if (std::abs(det) < 1e-15 || (det < 0 && !t.two_sided)) continue;
    const Vector3d s = eye - c[0].at;
    const double u = s.dot(p) / det;
    if (u < 0 || u > 1) continue;
    const Vector3d r = s.cross(e1);
    const double v = along.dot(r) / det, distance = e2.dot(r) / det;
    if (v < 0 || u + v > 1 || distance <= 0 || (nearest && distance >= nearest->distance_m)) continue;
    Hit hit{{}, c, {1 - u - v, u, v}, distance};
    const auto mixed = [&](auto member) {
      return std::remove_cvref_t<decltype(c[0].*member)>(
          hit.shares[0] * (c[0].*member) + hit.shares[1] * (c[1].*member) + hit.shares[2] * (c[2].*member));
    };
    hit.point.at = mixed(&Point::at);
    hit.point.normal = mixed(&Point::normal).normalized();
    hit.point.tangent = mixed(&Point::tangent);
    hit.point.uv = mixed(&Point::uv);
    hit.point.binormal_sign = c[0].binormal_sign;
    if (hit.point.normal.dot(along) > 0 && det < 0) hit.point.normal = -hit.point.normal;
    nearest = hit;
  }
  return nearest;
}

// Irradiance of a lamp relative to its maximum, and the direction to it: the distance law of SDFormat 1.9
// (<attenuation>), and the cone of a spot between its two angles, whose falloff is an exponent (OGRE 1.9 manual,
// "Spotlight").
inline std::pair<Vector3d, double> towards(const light_def_t& lamp, const Vector3d& at) {
  if (lamp.kind == light_def_t::DIRECTIONAL) return {-to_eigen(lamp.direction), 1};
  const Vector3d to = to_eigen(lamp.pose.position_m) - at, l = to.normalized();
  const double d = to.norm();
  if (d > lamp.range_m) return {l, 0};
  double strength =
      1 / (lamp.attenuation_constant + lamp.attenuation_linear * d + lamp.attenuation_quadratic * d * d);
  if (lamp.kind == light_def_t::SPOT) {
    const double rho = std::acos(-l.dot(to_eigen(lamp.direction).normalized()));
    const double inner = lamp.inner_angle_rad / 2.0, outer = lamp.outer_angle_rad / 2.0;
    if (rho >= outer) return {l, 0};
    if (rho > inner)
      strength *= std::pow((std::cos(rho) - std::cos(outer)) / (std::cos(inner) - std::cos(outer)), lamp.falloff);
  }
  return {l, strength};
}

// Phong's model (1975, "Illumination for Computer Generated Pictures") without shadows. The power of the cosine t
// is replaced by t / (n - n t + t) (Schlick 1994, "A fast alternative to Phong's specular model"). Ambient light
// comes from a hemisphere whose lower half is half as bright. texture: factor on diffuse light.
inline Vector3d phong(const scene_t& scene, const visual_def_t& m, const Point& p, const Vector3d& eye,
                      const Vector3d& texture = Vector3d::Ones()) {
  const Vector3d n = p.normal, v = (eye - p.at).normalized();
  Vector3d sum =
      to_eigen(m.emissive) +
      to_eigen(m.ambient).cwiseProduct(texture).cwiseProduct(to_eigen(scene.ambient)) * (0.75 + 0.25 * n.z());
  for (const light_def_t& lamp : scene.lights) {
    const auto [l, strength] = towards(lamp, p.at);
    const double nl = n.dot(l), s = m.shininess;
    if (nl <= 0) continue;
    const double t = std::max(0.0, (2 * nl * n - l).dot(v));
    sum += lamp.intensity * strength *
           (nl * to_eigen(lamp.diffuse).cwiseProduct(to_eigen(m.diffuse)).cwiseProduct(texture) +
            t / (s - s * t + t) * to_eigen(lamp.specular).cwiseProduct(to_eigen(m.specular)));
  }
  return sum;
}

// Evaluated at the corners and interpolated linearly (Gouraud 1971, "Continuous Shading of Curved Surfaces").
inline Vector3d gouraud(const scene_t& scene, const visual_def_t& m, const Hit& hit, const Vector3d& eye) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    sum += hit.shares[static_cast<Eigen::Index>(k)] * phong(scene, m, hit.corners[k], eye);
  return sum;
}

// Bilinear between texel centres, repeated (OpenGL 3.3, 3.8.11); value(column, row), rows from the lowest.
inline Vector3d bilinear(const sync::Raster& r, const Vector2d& uv, double (*decode)(double)) {
  const double x = uv.x() * r.width - 0.5, y = uv.y() * r.height - 0.5;
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const auto texel = [&](int column, int row) {
    column = (column % r.width + r.width) % r.width, row = (row % r.height + r.height) % r.height;
    const std::uint8_t* at = &r.rgba[static_cast<std::size_t>(4 * (row * r.width + column))];
    return Vector3d(decode(at[0]), decode(at[1]), decode(at[2]));
  };
  const double a = x - i, b = y - j;
  return (1 - b) * ((1 - a) * texel(i, j) + a * texel(i + 1, j)) +
         b * ((1 - a) * texel(i, j + 1) + a * texel(i + 1, j + 1));
}

// The normal of a normal map (glTF 2.0, 3.9.3), with its tangent orthogonal to the normal of the surface.
inline Vector3d mapped_normal(const Point& p, const Vector3d& m) {
  const Vector3d n = p.normal, t = (p.tangent - n * n.dot(p.tangent)).normalized();
  return (m.x() * t + m.y() * p.binormal_sign * n.cross(t) + m.z() * n).normalized();
}

// Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", eq. 15.
inline double fresnel(double at_normal, double cosine) {
  return at_normal + (1 - at_normal) * std::pow(1 - cosine, 5);
}

}  // namespace tactus::test::reference
