#include "sim_node/scene/view.h"

#include <cmath>
#include <numbers>
#include <sdf/Scene.hh>

#include "sim_node/scene/sdf/attributes.h"
#include "sim_node/scene/sdf/sdf_eigen.h"
#include "sim_node/scene/shapes.h"

namespace tactus::sim {
namespace {

constexpr double kDeg = std::numbers::pi / 180;

// +x towards the target, z up.
Eigen::Isometry3d look_pose(const Eigen::Vector3d& from, const Eigen::Vector3d& at) {
  const Eigen::Vector3d x = (at - from).normalized();
  const Eigen::Vector3d perpendicular = std::abs(x.z()) > 0.999 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ().cross(x);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << x, perpendicular.normalized(), x.cross(perpendicular.normalized());
  pose.translation() = from;
  return pose;
}

// A pose, or a position and a point to look at.
std::optional<Eigen::Isometry3d> read_viewpoint(const LoadContext& context, const sdf::Element& element, Attributes& attributes) {
  const auto pose = attributes.pose("pose");
  const auto position = attributes.position("position"), at = attributes.position("look_at");
  if (pose && (position || at)) context.reject(element, "has both a pose and a position: give one");
  if (position.has_value() != at.has_value()) context.reject(element, "needs position and look_at together");
  if (position && (*position - *at).norm() < 1e-6) context.reject(element, "looks at itself");
  return position ? look_pose(*position, *at) : pose;
}

bool read_tactus_camera(LoadContext& context, const sdf::ElementPtr& world) {
  const sdf::ElementPtr element = explicit_child(world, "tactus:camera");
  if (!element) return false;
  Attributes attributes(context, *element);
  const auto place = read_viewpoint(context, *element, attributes);
  if (!place) context.reject(*element, "lacks its pose, or position and look_at");
  context.world.camera = *place;
  context.world.camera_fov_rad = attributes.quantity("fov", "rad", 1 * kDeg, 170 * kDeg).value_or(60 * kDeg);
  attributes.done();
  return true;
}

bool read_gui_camera(LoadContext& context, const sdf::ElementPtr& world) {
  const sdf::ElementPtr pose = explicit_child(explicit_child(explicit_child(world, "gui"), "camera"), "pose");
  if (!pose) return false;
  context.world.camera = to_eigen(pose->Get<ignition::math::Pose3d>());
  if (!context.world.camera.matrix().allFinite()) context.reject(*pose, "is not finite");
  context.world.camera_fov_rad = 60 * kDeg;  // as in Gazebo's window
  return true;
}

bool read_camera_sensor(LoadContext& context) {
  if (!context.camera_sensor) return false;
  context.world.camera = context.camera_sensor_pose;
  const auto fov = explicit_child(explicit_child(context.camera_sensor, "camera"), "horizontal_fov");
  const double angle = fov ? fov->Get<double>() : 1.047;  // SDF's default
  context.world.camera_fov_rad = std::min(std::max(angle, kDeg), 170 * kDeg);
  return true;
}

// From the front, right and above, at the distance that shows the bounding sphere of all bodies.
void frame_all_bodies(LoadContext& context) {
  Eigen::AlignedBox3d bounding_box;
  for (const ShapeDef& shape : context.world.shapes) {
    ShapeDef placed = shape;
    placed.pose = context.world.bodies[static_cast<std::size_t>(shape.body)].pose * shape.pose;
    if (shape.kind != ShapeKind::kHeightfield) bounding_box.extend(bounds(context.world, placed));
  }
  if (bounding_box.isEmpty()) bounding_box.extend(Eigen::Vector3d::Zero());
  const double radius = std::max(bounding_box.sizes().norm() / 2, 0.1);
  const double vertical_fov = 2 * std::atan(std::tan(30 * kDeg) * 0.75);
  const double distance = std::min(radius / std::sin(vertical_fov / 2), 1e5);
  const Eigen::Vector3d from = bounding_box.center() + distance * Eigen::Vector3d(-0.7, -0.5, 0.5).normalized();
  context.world.camera = look_pose(from, bounding_box.center());
  context.world.camera_fov_rad = 60 * kDeg;
}

void read_ambient_light(LoadContext& context, const sdf::World* world, const sdf::ElementPtr& element) {
  const sdf::ElementPtr scene = explicit_child(element, "scene");
  const auto colour = [&](const char* name, const ignition::math::Color& given, const Eigen::Vector3d& missing) {
    const Eigen::Vector3d value = explicit_child(scene, name) ? to_eigen(given) : missing;
    if (!value.allFinite()) context.reject(*scene, "has a colour that is not finite");
    return Eigen::Vector3d(value.cwiseMax(0).cwiseMin(1));
  };
  const sdf::Scene* given = world ? world->Scene() : nullptr;
  // SDF's defaults (scene.sdf).
  context.world.ambient = colour("ambient", given ? given->Ambient() : ignition::math::Color(), {0.4, 0.4, 0.4});
  context.world.background = colour("background", given ? given->Background() : ignition::math::Color(), {0.7, 0.7, 0.7});
}

}  // namespace

void read_view(LoadContext& context, const sdf::World* world, const sdf::ElementPtr& element) {
  if (!read_tactus_camera(context, element) && !read_gui_camera(context, element) && !read_camera_sensor(context))
    frame_all_bodies(context);
  context.world.listener = context.world.camera;
  if (const sdf::ElementPtr listener = explicit_child(element, "tactus:listener")) {
    Attributes attributes(context, *listener);
    const auto place = read_viewpoint(context, *listener, attributes);
    if (!place) context.reject(*listener, "lacks its pose, or position and look_at");
    context.world.listener = *place;
    attributes.done();
  }
  read_ambient_light(context, world, element);
}

}  // namespace tactus::sim
