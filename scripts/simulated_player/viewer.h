// The eye that looks at a scene's picture: directions in the picture, and a ray test of the visible share of a ball. Pure.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <tactus/scene_t.hpp>
#include <vector>

namespace tactus::simulated_player {

// The axes of the line of sight to a point: right and up across it, and the horizontal direction away from the eye. Unit
// vectors, world.
struct SightLine {
  Eigen::Vector3d right{0, -1, 0}, up{0, 0, 1}, away{1, 0, 0};
  double distance_m = 1;
  double sine = 1, cosine = 0;  // of the angle below the horizon: up = sine * away + cosine * z
};

struct Viewer {
  Eigen::Vector3d eye_m{0, 0, 1};
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // columns: right, up, forward
  double focal_px = 554;                               // of the undegraded picture

  // The axes of the sight of this point. An eye above or beside the point gives finite axes.
  SightLine line_to(const Eigen::Vector3d& point_m) const;
};

// The view of the scene's camera in a picture of this width, px. Without a field of view: 60 degrees, as visual_node draws it.
Viewer viewer_of(const scene_t& scene, int width_px = 640);

// The pose T_world_body of a body in the picture.
using BodyPoses = std::function<Eigen::Isometry3d(int body)>;

// The drawn shapes that can hide a thing: boxes, spheres, cylinders, capsules and planes. Meshes and things with an alpha below
// one half hide nothing: a limit of the ray test against the pixels of a picture.
class Occluders {
 public:
  explicit Occluders(const scene_t& scene);

  // Share of a ball, 0 to 1, that an eye at eye_m sees: seven rays, to the middle and to six points of its disc at 0.8 of the
  // radius. body: of the ball, which does not hide itself.
  double visible_share(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& centre_m, double radius_m, int body,
                       const BodyPoses& poses) const;
  // Bodies that move and can hide something.
  const std::vector<int>& moving() const { return moving_; }

 private:
  struct Shape {
    int body, kind;
    bool fixed;
    Eigen::Isometry3d pose;  // T_world_shape of a fixed shape, else T_body_shape
    Eigen::Vector3d size_m;
    double bound_m;  // radius of a sphere about its origin; 0: unlimited
  };
  std::vector<Shape> shapes_;
  std::vector<int> moving_;
};

}  // namespace tactus::simulated_player
