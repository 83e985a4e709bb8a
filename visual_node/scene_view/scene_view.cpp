#include "visual_node/scene_view/scene_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tactus/light_def_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/vec3f_t.hpp>
#include <tactus/visual_def_t.hpp>
#include <tuple>
#include <utility>

#include "lcmtypes/pointing.h"
#include "lcmtypes/vectors.h"
#include "visual_node/scene_view/lighting.h"
#include "visual_node/scene_view/repeated_place.h"

namespace tactus::visual {
namespace {

// Segments around a round shape per level, and the radius in pixels above which the next finer level is used: a
// polygon of n segments errs by r (1 - cos(pi / n)), which then stays below 3/4 of a pixel. More segments are
// expensive on a software renderer, which shades every triangle in blocks of 4 x 4 pixels.
constexpr std::array kSegments{12, 20, 40};
constexpr std::array kCoarserBelow_px{22.0f, 61.0f};

// Minimum radius of a drawn tool: that of a pencil's tip.
constexpr double kMinTool_m = 0.004;
// Colour of a tool without visuals: a blue that none of our materials has.
const Eigen::Vector3f kToolColour{0.10f, 0.42f, 0.95f};

// Placeholder of a missing mesh: the size of a hand-held object, in a conspicuous colour (design).
constexpr float kMissing_m = 0.06f;
const Eigen::Vector3f kMissingColour{1.0f, 0.0f, 1.0f};

// Colours of consecutive bodies differ: hues a golden angle apart.
Eigen::Vector3f body_colour(int body) {
  constexpr double kGoldenAngle_rad = 2.399963;  // 2 pi (1 - 1 / golden ratio)
  const double hue = kGoldenAngle_rad * body;
  const auto channel = [&](int k) {
    return static_cast<float>(0.45 + 0.3 * std::cos(hue + 2 * std::numbers::pi * k / 3));
  };
  return {channel(0), channel(1), channel(2)};
}

Eigen::Vector4f with(const vec3f_t& v, float w) { return {v.x, v.y, v.z, w}; }

int multiple_of_4(int pixels) { return pixels / 4 * 4; }

}  // namespace

SceneView::SceneView(const scene_t& scene, const Meshes& meshes, const Settings& settings,
                     const HeightMaps& height_maps, LookFiles look_files)
    : width_(multiple_of_4(settings.width)),
      height_(multiple_of_4(settings.height)),
      lens_(scene, settings, width_, height_),
      settings_(settings) {
  lighting_ = make_lighting(scene, settings);
  lamps_.assign(scene.lights.begin(), scene.lights.begin() + static_cast<std::ptrdiff_t>(lighting_.lights.size()));
  appearance_ = make_appearance(scene, std::move(look_files));
  geometries_ = {unit_plane(), unit_box()};
  for (const int n : kSegments) geometries_.push_back(unit_sphere(n));
  for (const int n : kSegments) geometries_.push_back(unit_cylinder(n));
  add_reliefs(scene, height_maps);
  if (settings.geometry == "physics")
    for (const shape_def_t& s : scene.shapes) add_collision_shape(s, meshes);
  else
    for (const visual_def_t& v : scene.visuals) add(v, meshes);
  for (const tool_def_t& t : scene.tools) add_tool(scene, t, meshes);
  // The housing of a lamp would block all of its light.
  for (ShapePart& p : parts_) p.casts_shadow = p.casts_shadow && !lamp_inside(scene, p);
  for (Tool& t : tools_) t.ghost.instance.diffuse.w() = static_cast<float>(settings.ghost_alpha);
}

// Materials with the same inherited height map share one relief.
void SceneView::add_reliefs(const scene_t& scene, const HeightMaps& height_maps) {
  std::map<std::tuple<std::int64_t, double, double, double>, int> known;
  for (const material_def_t& m : scene.materials) {
    int& relief = relief_of_material_.emplace_back(-1);
    const auto map = height_maps.find(m.bump_asset);
    if (m.bump_asset == 0 || map == height_maps.end()) continue;
    const auto [at, fresh] = known.try_emplace({m.bump_asset, m.bump_size_u_m, m.bump_size_v_m, m.bump_height_m},
                                               static_cast<int>(reliefs_.size()));
    if (fresh) reliefs_.push_back(make_relief(map->second, m));
    relief = at->second;
  }
}

void SceneView::add(const visual_def_t& v, const Meshes& meshes) {
  ShapePart part;
  if (v.alpha <= 0) return;
  const bool known = shape(v.shape, meshes, part);
  part.body = v.shape.body;
  part.in_body = to_eigen(v.shape.pose);
  if (v.shape.material >= 0 && v.shape.material < static_cast<int>(relief_of_material_.size()))
    part.relief = relief_of_material_[static_cast<std::size_t>(v.shape.material)];
  part.instance.scale.w() = std::max(v.shininess, 1.0f);
  part.instance.diffuse = with(v.diffuse, std::min(v.alpha, 1.0f));
  part.instance.specular = with(v.specular, 0);
  part.instance.ambient = with(v.ambient, 0);
  part.instance.emissive = with(v.emissive, 0);
  if (v.look >= 0 && v.look < static_cast<int>(appearance_.looks.size()) - 1) part.look = v.look + 1;
  known ? check_look(v, part) : mark_missing(v.shape, part);
  parts_.push_back(part);
}

// Draws the collision shapes, each in the colour of its body.
void SceneView::add_collision_shape(const shape_def_t& s, const Meshes& meshes) {
  ShapePart part;
  const bool known = shape(s, meshes, part);
  part.body = s.body;
  part.in_body = to_eigen(s.pose);
  part.instance.scale.w() = 16;
  part.instance.diffuse << body_colour(s.body), 1;
  part.instance.ambient << body_colour(s.body), 0;
  if (!known) mark_missing(s, part);
  parts_.push_back(part);
}

void SceneView::mark_missing(const shape_def_t& s, ShapePart& part) {
  part.geometry = kBox;
  part.radius_m = kMissing_m;
  part.casts_shadow = false;
  part.relief = -1, part.look = 0;
  part.instance = {};
  part.instance.scale = {kMissing_m, kMissing_m, kMissing_m, 16};
  part.instance.diffuse << kMissingColour, 1;
  part.instance.emissive << kMissingColour, 0;
  warnings_.push_back("the mesh of " + s.name + " is missing or damaged: a magenta box of " +
                      std::to_string(std::lround(1000 * kMissing_m)) + " mm is drawn where it is");
}

void SceneView::check_look(const visual_def_t& v, const ShapePart& part) {
  const Look& look = appearance_.looks[static_cast<std::size_t>(part.look)];
  const Triangles& t = geometries_[static_cast<std::size_t>(part.geometry)];
  if (look.mapped() && t.texcoords.empty())
    warnings_.push_back("look " + look.name + " lays a picture on " + v.shape.name +
                        ", whose mesh has no texture coordinates: all of it shows one point of the picture");
  else if (look.normal_map >= 0 && t.tangents.empty())
    warnings_.push_back("look " + look.name + " has a normal map, but the mesh of " + v.shape.name +
                        " no tangents: it is drawn smooth");
}

void SceneView::add_tool(const scene_t& scene, const tool_def_t& tool, const Meshes& meshes) {
  ShapePart ball;
  shape_def_t form{};
  form.kind = tool.shape == tool_def_t::BOX       ? shape_def_t::BOX
              : tool.shape == tool_def_t::CAPSULE ? shape_def_t::CAPSULE
              : tool.shape == tool_def_t::MESH    ? shape_def_t::MESH
                                                  : shape_def_t::SPHERE;
  form.size_m = tool.size_m;
  form.mesh_hash = tool.mesh_hash;
  if (form.kind == shape_def_t::SPHERE) form.size_m.x = std::max(tool.radius_m, kMinTool_m);
  // A tool without its mesh is drawn as a ball, so that the hand is visible.
  if (!shape(form, meshes, ball)) {
    form.kind = shape_def_t::SPHERE;
    form.size_m.x = std::max(tool.radius_m, kMinTool_m);
    shape(form, meshes, ball);
  }
  ball.body = tool.body;
  ball.instance.scale.w() = 40;
  ball.instance.diffuse << kToolColour, 1;
  ball.instance.specular = {0.5f, 0.5f, 0.5f, 0};
  // It glows slightly, so that the hand is visible in the dark.
  ball.instance.ambient << kToolColour, 0;
  ball.instance.emissive << 0.12f * kToolColour, 0;
  const bool has_visual =
      std::any_of(parts_.begin(), parts_.end(), [&](const ShapePart& p) { return p.body == tool.body; });
  const int light = steered_light(tool, scene.lights);
  // A pointing device is drawn only while it is in use.
  if (!has_visual && !only_points(tool, scene.lights) && tool.body < static_cast<int>(scene.bodies.size()))
    parts_.push_back(ball);
  tools_.push_back({tool.body, ball, light, steers_view(tool),
                    light >= 0 ? scene.lights[static_cast<std::size_t>(light)] : light_def_t{}});
}

bool SceneView::shape(const shape_def_t& s, const Meshes& meshes, ShapePart& part) {
  const Eigen::Vector3f size = to_eigen(s.size_m).cast<float>();
  const float r = size.x();
  const auto scaled = [&](float x, float y, float z) { part.instance.scale = {x, y, z, 1}; };
  switch (s.kind) {
    case shape_def_t::BOX:
      part.geometry = kBox;
      part.radius_m = size.norm() / 2;
      scaled(size.x(), size.y(), size.z());
      return true;
    case shape_def_t::SPHERE:
      part.geometry = kSphere;
      part.levels = true;
      part.radius_m = r;
      scaled(r, r, r);
      return true;
    case shape_def_t::CYLINDER:
      part.geometry = kCylinder;
      part.levels = true;
      part.radius_m = std::max(r, size.z() / 2);
      scaled(r, r, size.z());
      return true;
    case shape_def_t::CAPSULE:
      part.geometry = static_cast<int>(geometries_.size());
      part.radius_m = r + size.z() / 2;
      geometries_.push_back(capsule(r, size.z(), kSegments[1]));
      return true;
    case shape_def_t::PLANE:
      part.geometry = kPlane;
      part.radius_m = std::max(size.x(), size.y());
      part.casts_shadow = false;
      scaled(size.x(), size.y(), 1);
      return true;
    case shape_def_t::MESH: {
      const auto mesh = meshes.find(s.mesh_hash);
      if (mesh == meshes.end()) return false;
      const auto [at, fresh] = mesh_geometry_.try_emplace(s.mesh_hash, static_cast<int>(geometries_.size()));
      if (fresh) geometries_.push_back(from_mesh(mesh->second));
      part.geometry = at->second;
      for (const auto& p : geometries_[static_cast<std::size_t>(part.geometry)].positions)
        part.radius_m = std::max(part.radius_m, p.norm());
      return true;
    }
    default: return false;
  }
}

bool SceneView::lamp_inside(const scene_t& scene, const ShapePart& part) const {
  if (lighting_.shadow_light < 0) return false;
  const Eigen::Vector3d lamp = to_eigen(scene.lights[static_cast<std::size_t>(lighting_.shadow_light)].pose.position_m);
  const auto body = static_cast<std::size_t>(part.body);
  const Eigen::Isometry3d pose =
      (body < scene.bodies.size() ? to_eigen(scene.bodies[body].pose) : Eigen::Isometry3d::Identity()) *
      part.in_body;
  // Excludes shapes as large as a room, whose bounding sphere contains everything.
  return part.radius_m < 0.5f && (pose.translation() - lamp).norm() < static_cast<double>(part.radius_m);
}

namespace {
// Share of a tint that is emitted, so that it is visible in a dark room.
constexpr float kTintGlow = 0.12f;

void add_tint(Instance& instance, const Eigen::Vector4f& tint) {
  const Eigen::Vector3f linear = tint.head<3>().array().pow(2.2f);
  const float share = tint.w();
  instance.diffuse.head<3>() = (1 - share) * instance.diffuse.head<3>() + share * linear;
  instance.ambient.head<3>() = (1 - share) * instance.ambient.head<3>() + share * linear;
  instance.emissive.head<3>() += share * kTintGlow * linear;
}
}  // namespace

SceneView::PlacedInstance SceneView::place(const ShapePart& part, const Eigen::Isometry3d& body,
                                           const Camera& camera) const {
  const Eigen::Isometry3d pose = body * part.in_body;
  const Eigen::Quaternionf q(Eigen::Quaterniond(pose.linear()).cast<float>());
  PlacedInstance p{part.geometry, 0, part.casts_shadow, part.relief, part.look, part.instance};
  p.instance.orientation = q.coeffs();
  p.instance.position.head<3>() = camera.about_origin(pose.translation());
  p.instance.body_orientation = Eigen::Quaternionf(Eigen::Quaterniond(body.linear()).cast<float>()).coeffs();
  p.instance.body_position.head<3>() = camera.about_origin(
      part.relief < 0 ? Eigen::Vector3d(body.translation())
                      : repeated_place(reliefs_[static_cast<std::size_t>(part.relief)].size_m.cast<double>(), body, camera.origin_m));
  if (part.body >= 0 && part.body < static_cast<int>(tints_.size()))
    add_tint(p.instance, tints_[static_cast<std::size_t>(part.body)]);
  p.distance_m = (p.instance.position.head<3>() - camera.eye).norm();
  if (part.levels) {
    const float radius_px = part.instance.scale.x() * camera.focal_px / std::max(p.distance_m, 1e-3f);
    for (const float limit : kCoarserBelow_px) p.geometry += radius_px >= limit;
  }
  return p;
}

DrawList SceneView::draw(std::span<const Eigen::Isometry3d> bodies, std::span<const ToolPose> tools,
                         const std::optional<Eigen::Isometry3d>& head) const {
  DrawList list;
  list.camera = lens_.camera(head);
  list.views = stereo_views(lens_, head, settings_);
  list.lighting = lighting_;
  const Eigen::Vector3d& origin_m = list.camera.origin_m;
  if (!origin_m.isZero(0)) set_origin(list.lighting, lamps_, origin_m);
  std::vector<PlacedInstance> opaque, translucent;
  const auto add = [&](const ShapePart& part, const Eigen::Isometry3d& pose) {
    const bool seen_through =
        part.instance.diffuse.w() < 1 || appearance_.looks[static_cast<std::size_t>(part.look)].translucent;
    (seen_through ? translucent : opaque).push_back(place(part, pose, list.camera));
  };
  const auto tool_of = [&](int body) {
    for (std::size_t i = 0; i < std::min(tools.size(), tools_.size()); ++i)
      if (tools_[i].body == body && tools[i].known) return static_cast<int>(i);
    return -1;
  };
  for (const ShapePart& part : parts_) {
    const int tool = tool_of(part.body);
    if (tool >= 0)
      add(part, tools[static_cast<std::size_t>(tool)].proxy);
    else if (part.body >= 0 && part.body < static_cast<int>(bodies.size()))
      add(part, bodies[static_cast<std::size_t>(part.body)]);
  }
  for (std::size_t i = 0; i < std::min(tools.size(), tools_.size()); ++i)
    if (tools[i].known && !tools_[i].hidden) add(tools_[i].ghost, tools[i].device);
  for (std::size_t i = 0; i < std::min(tools.size(), tools_.size()); ++i)
    if (tools[i].known && tools_[i].light >= 0)
      aim(list.lighting, static_cast<std::size_t>(tools_[i].light), tools_[i].lamp, tools[i].device.translation(), origin_m);

  // Planes and boxes have the lowest numbers and are mostly floors and walls: they are drawn last, to reduce
  // overdraw.
  std::sort(opaque.begin(), opaque.end(), [](const PlacedInstance& a, const PlacedInstance& b) {
    return std::tuple(-a.geometry, a.casts_shadow, a.relief, a.look, a.distance_m) <
           std::tuple(-b.geometry, b.casts_shadow, b.relief, b.look, b.distance_m);
  });
  std::sort(translucent.begin(), translucent.end(),
            [](const PlacedInstance& a, const PlacedInstance& b) { return a.distance_m > b.distance_m; });
  const auto append = [&](const std::vector<PlacedInstance>& from, std::vector<Batch>& to) {
    for (const PlacedInstance& p : from) {
      const auto first = static_cast<int>(list.instances.size());
      if (to.empty() || to.back().geometry != p.geometry || to.back().casts_shadow != p.casts_shadow ||
          to.back().relief != p.relief || to.back().look != p.look)
        to.push_back({p.geometry, first, 0, p.casts_shadow, p.relief, p.look});
      ++to.back().count;
      list.instances.push_back(p.instance);
    }
  };
  append(opaque, list.opaque);
  append(translucent, list.translucent);
  return list;
}

}  // namespace tactus::visual
