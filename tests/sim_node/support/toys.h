// Balls, boxes and rods with exact contacts from a few lines of geometry, to test the impulse solver without a
// collision detector.
#pragma once

#include <algorithm>
#include <vector>

#include "sim_node/behaviour/impulse/world.h"

namespace tactus::sim::test {

inline constexpr double kToyG = 9.81;

class Toys {
 public:
  explicit Toys(impulse::ContactLaw law = {}) : world(law) {}

  impulse::World world;
  Eigen::Vector3d gravity_m_s2{0, 0, -kToyG};
  double reach_m = 0.02;  // gaps up to this, and up to the motion of a step, create contacts

  int plane(const Eigen::Vector3d& normal, const Eigen::Vector3d& point, double friction = 0.5,
            double restitution = 0) {
    return shape({.kind = Kind::kPlane, .body = world.add_fixed(), .from = point, .to = normal}, friction,
                 restitution);
  }
  int ball(double mass, double r, const Eigen::Vector3d& place, double friction = 0.5, double restitution = 0) {
    impulse::FreeBody b = body(mass, 0.4 * mass * r * r * Eigen::Matrix3d::Identity(),
                               Eigen::Isometry3d(Eigen::Translation3d(place)));
    return shape({.kind = Kind::kRod, .body = world.add_free(b), .radius = r}, friction, restitution);
  }
  int box(double mass, const Eigen::Vector3d& size, const Eigen::Isometry3d& pose, double friction = 0.5,
          double restitution = 0) {
    const Eigen::Vector3d q = size.cwiseAbs2();
    const Eigen::Matrix3d inertia =
        (mass / 12 * Eigen::Vector3d(q.y() + q.z(), q.x() + q.z(), q.x() + q.y())).asDiagonal();
    return shape({.kind = Kind::kBox, .body = world.add_free(body(mass, inertia, pose)), .size = size}, friction,
                 restitution);
  }
  // A thin rod of this length along its x axis, in contact by its round ends and side.
  int rod(double mass, double length, double r, const Eigen::Isometry3d& pose, double friction = 0.5,
          double restitution = 0) {
    const double across = mass * length * length / 12, about = mass * r * r / 2;
    const Eigen::Matrix3d inertia = Eigen::Vector3d(about, across, across).asDiagonal();
    return capsule(world.add_free(body(mass, inertia, pose)), length, r, Eigen::Vector3d::UnitX(), friction,
                   restitution);
  }
  // A capsule about the centre of an existing body, along an axis of it.
  int capsule(int body, double length, double r, const Eigen::Vector3d& along, double friction = 0.5,
              double restitution = 0) {
    return shape(
        {.kind = Kind::kRod, .body = body, .radius = r, .from = -length / 2 * along, .to = length / 2 * along},
        friction, restitution);
  }

  const std::vector<Manifold>& contacts() const { return contacts_; }
  void collide(double h) {
    contacts_.clear();
    for (std::size_t i = 0; i < shapes_.size(); ++i)
      for (std::size_t j = i + 1; j < shapes_.size(); ++j) pair(i, j, h);
  }
  void step(double h) {
    collide(h);
    world.step(contacts_, h);
  }
  // Solves the contacts that collide() found.
  void solve(double h) { world.step(contacts_, h); }
  double min_gap_m() {
    collide(0);
    double least = 1;
    for (const Manifold& m : contacts_)
      for (const ManifoldPoint& p : m.used()) least = std::min(least, -p.depth_m);
    return least;
  }
  double force_N() const {
    double sum = 0;
    for (const Manifold& m : contacts_)
      for (const ManifoldPoint& p : m.used()) sum += p.normal_force_N;
    return sum;
  }
  const BodyMotion& motion(int body) const { return world.motions()[static_cast<std::size_t>(body)]; }

 private:
  enum class Kind { kPlane, kBox, kRod };
  struct Shape {
    Kind kind = Kind::kPlane;
    int body = 0;
    double radius = 0;
    Eigen::Vector3d size = Eigen::Vector3d::Zero();
    Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();  // a plane's point and normal
  };
  impulse::FreeBody body(double mass, const Eigen::Matrix3d& inertia, const Eigen::Isometry3d& pose) const {
    impulse::FreeBody b;
    b.mass_kg = mass;
    b.inertia_kg_m2 = inertia;
    b.gravity_m_s2 = gravity_m_s2;
    b.centre_m = pose.translation();
    b.orientation = Eigen::Quaterniond(pose.linear()).normalized();
    return b;
  }
  int shape(const Shape& s, double friction, double restitution) {
    shapes_.push_back(s);
    world.add_surface({friction, restitution});
    return s.body;
  }
  void add(Manifold& m, const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double gap) const {
    ManifoldPoint p;
    p.point_m = point;
    p.normal = normal;
    p.depth_m = -gap;
    m.points[static_cast<std::size_t>(m.count++)] = p;
  }
  // The corners of a box nearest to a plane, and the ends of a rod.
  void against_plane(Manifold& m, const Shape& s, const Eigen::Vector3d& n, const Eigen::Vector3d& on,
                     double reach) const {
    const BodyMotion& b = motion(s.body);
    std::vector<std::pair<double, Eigen::Vector3d>> near;
    const auto candidate = [&](const Eigen::Vector3d& local, double r) {
      const Eigen::Vector3d p = b.to_world(local) - r * n;
      const double gap = n.dot(p - on);
      if (gap < reach) near.emplace_back(gap, p);
    };
    if (s.kind == Kind::kBox) {
      for (int corner = 0; corner < 8; ++corner)
        candidate(0.5 * s.size.cwiseProduct(
                            Eigen::Vector3d(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1)),
                  0);
    } else {
      candidate(s.from, s.radius);
      if (s.from != s.to) candidate(s.to, s.radius);
    }
    std::stable_sort(near.begin(), near.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    for (std::size_t i = 0; i < std::min<std::size_t>(4, near.size()); ++i)
      add(m, near[i].second, n, near[i].first);
  }
  void pair(std::size_t i, std::size_t j, double h) {
    const Shape &a = shapes_[i], &b = shapes_[j];
    if (b.kind == Kind::kPlane || a.body == b.body) return;
    Manifold m;
    m.shape_a = static_cast<int>(i), m.shape_b = static_cast<int>(j);
    m.body_a = a.body, m.body_b = b.body;
    const BodyMotion &ma = motion(a.body), &mb = motion(b.body);
    const double speed =
        (mb.velocity_m_s - ma.velocity_m_s).norm() + mb.spin_rad_s.norm() + ma.spin_rad_s.norm() + kToyG * h;
    const double reach = reach_m + speed * h;
    if (a.kind == Kind::kPlane) {
      against_plane(m, b, a.to, a.from, reach);
    } else if (a.kind == Kind::kBox && b.kind == Kind::kBox) {
      // The upper box rests on top of the lower one.
      const Eigen::Vector3d n = ma.orientation * Eigen::Vector3d::UnitZ();
      const Eigen::Vector3d top = ma.to_world({0, 0, a.size.z() / 2});
      const Eigen::Vector3d between = mb.centre_m - ma.centre_m;
      if (between.head<2>().norm() < a.size.head<2>().minCoeff() / 2 && between.z() > 0)
        against_plane(m, b, n, top, reach);
    } else if (a.kind == Kind::kRod && b.kind == Kind::kRod && (a.from == a.to || b.from == b.to)) {
      const bool ball_first = a.from == a.to;
      const Shape &ball = ball_first ? a : b, &rod = ball_first ? b : a;
      const Eigen::Vector3d c = motion(ball.body).centre_m, p = motion(rod.body).to_world(rod.from),
                            d = motion(rod.body).to_world(rod.to) - p;
      const double t = d.squaredNorm() > 0 ? std::clamp((c - p).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0;
      const Eigen::Vector3d to_ball = c - (p + t * d), n = to_ball.normalized();
      const double gap = to_ball.norm() - a.radius - b.radius;
      if (gap < reach) add(m, p + t * d + rod.radius * n, ball_first ? -n : n, gap);
    }
    if (m.count > 0) contacts_.push_back(m);
  }

  std::vector<Shape> shapes_;
  std::vector<Manifold> contacts_;
};

}  // namespace tactus::sim::test
