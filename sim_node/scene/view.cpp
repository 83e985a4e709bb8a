#include "sim_node/scene/view.h"

#include <cmath>
#include <numbers>

#include "sim_node/scene/sdf/attributes.h"
#include "sim_node/scene/sdf/values.h"
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

bool read_tactus_camera(LoadContext& context, const sdf::Element& world) {
  const sdf::Element* element = world.child("tactus:camera");
  if (!element) return false;
  Attributes attributes(context, *element);
  const auto place = read_viewpoint(context, *element, attributes);
  if (!place) context.reject(*element, "lacks its pose, or position and look_at");
  context.world.camera = *place;
  context.world.camera_fov_rad = attributes.quantity("fov", "rad", 1 * kDeg, 170 * kDeg).value_or(60 * kDeg);
  attributes.done();
  return true;
}

bool read_gui_camera(LoadContext& context, const sdf::Element& world) {
  const sdf::Element* pose = sdf::child_of(sdf::child_of(world.child("gui"), "camera"), "pose");
  if (!pose) return false;
  context.world.camera = sdf::raw_pose(*pose).to_eigen();
  if (!context.world.camera.matrix().allFinite()) context.reject(*pose, "is not finite");
  context.world.camera_fov_rad = 60 * kDeg;  // as in Gazebo's window
  return true;
}

bool read_camera_sensor(LoadContext& context) {
  if (!context.camera_sensor) return false;
  context.world.camera = context.camera_sensor_pose;
  const double angle = sdf::child_number(context.camera_sensor->child("camera"), "horizontal_fov", 1.047);  // SDF's default
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

void read_ambient_light(LoadContext& context, const sdf::Element& world) {
  const sdf::Element* scene = world.child("scene");
  // SDF's defaults (scene.sdf).
  const auto ambient = sdf::child_colour(scene, "ambient"), background = sdf::child_colour(scene, "background");
  context.world.ambient = ambient ? ambient->rgb : Eigen::Vector3d(0.4, 0.4, 0.4);
  context.world.background = background ? background->rgb : Eigen::Vector3d(0.7, 0.7, 0.7);
}

}  // namespace

void read_view(LoadContext& context, const sdf::Element& world) {
  if (!read_tactus_camera(context, world) && !read_gui_camera(context, world) && !read_camera_sensor(context))
    frame_all_bodies(context);
  context.world.listener = context.world.camera;
  if (const sdf::Element* listener = world.child("tactus:listener")) {
    Attributes attributes(context, *listener);
    const auto place = read_viewpoint(context, *listener, attributes);
    if (!place) context.reject(*listener, "lacks its pose, or position and look_at");
    context.world.listener = *place;
    attributes.done();
  }
  read_ambient_light(context, world);
}

}  // namespace tactus::sim
