// Converts a scene and the poses of its bodies into a draw list. Constructed for each scene.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <span>
#include <tactus/light_def_t.hpp>
#include <tactus/mesh_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/visual_def_t.hpp>
#include <vector>

#include "visual_node/lens/lens.h"
#include "visual_node/scene_view/draw_list.h"
#include "visual_node/scene_view/look.h"
#include "visual_node/scene_view/relief.h"
#include "visual_node/scene_view/triangles.h"
#include "visual_node/settings.gen.h"

namespace tactus::visual {

using Meshes = std::map<std::int64_t, mesh_t>;  // by content hash

// The poses of one tool at the instant of a frame.
struct ToolPose {
  bool known = false;
  Eigen::Isometry3d device = Eigen::Isometry3d::Identity();  // T_world_device
  Eigen::Isometry3d proxy = Eigen::Isometry3d::Identity();   // T_world_proxy
};

class SceneView {
 public:
  // A shape whose mesh is missing is drawn as a conspicuous box and counted; a shape whose height map is missing
  // is smooth.
  SceneView(const scene_t& scene, const Meshes& meshes, const Settings& settings,
            const HeightMaps& height_maps = {}, LookFiles look_files = {});

  // The triangles that batches refer to, by index.
  const std::vector<Triangles>& geometries() const { return geometries_; }
  // The reliefs that batches refer to, by index.
  const std::vector<Relief>& reliefs() const { return reliefs_; }
  // The looks that batches refer to, by index, and the environment.
  const Appearance& appearance() const { return appearance_; }
  const Lighting& lighting() const { return lighting_; }
  const Lens& lens() const { return lens_; }
  // One sentence for each thing that is not drawn as the scene defines it.
  const std::vector<std::string>& warnings() const { return warnings_; }
  int width() const { return width_; }
  int height() const { return height_; }

  // Sets colours of bodies: sRGB and their weight, 0 .. 1. Bodies beyond the end of the list keep their own
  // colour.
  void tint(std::vector<Eigen::Vector4f> bodies) { tints_ = std::move(bodies); }

  // Takes one pose T_world_body for each body and one entry for each tool; a known tool is drawn at its proxy.
  // head: T_world_head; nothing: the pose of the scene's camera.
  DrawList draw(std::span<const Eigen::Isometry3d> bodies, std::span<const ToolPose> tools,
                const std::optional<Eigen::Isometry3d>& head = {}) const;

 private:
  // The order of geometries_; kLevels: number of subdivisions of round shapes.
  static constexpr int kPlane = 0, kBox = 1, kSphere = 2, kCylinder = 5, kLevels = 3;

  struct ShapePart {  // one visible shape
    int body = 0;
    Eigen::Isometry3d in_body = Eigen::Isometry3d::Identity();  // T_body_shape
    int geometry = 0;                                           // index of the coarsest level
    bool levels = false;                                        // finer levels follow it
    float radius_m = 0;  // radius of its bounding sphere about the origin of the shape
    bool casts_shadow = true;
    int relief = -1;
    int look = 0;       // index in Appearance::looks
    Instance instance;  // all except its pose
  };
  struct PlacedInstance {
    int geometry;
    float distance_m;
    bool casts_shadow;
    int relief;
    int look;
    Instance instance;
  };

  void add_reliefs(const scene_t& scene, const HeightMaps& height_maps);
  void add(const visual_def_t& visual, const Meshes& meshes);
  void add_collision_shape(const shape_def_t& shape, const Meshes& meshes);
  void mark_missing(const shape_def_t& shape, ShapePart& part);
  void check_look(const visual_def_t& visual, const ShapePart& part);
  void add_tool(const scene_t& scene, const tool_def_t& tool, const Meshes& meshes);
  bool shape(const shape_def_t& shape, const Meshes& meshes, ShapePart& part);
  bool lamp_inside(const scene_t& scene, const ShapePart& part) const;
  PlacedInstance place(const ShapePart& part, const Eigen::Isometry3d& body, const Camera& camera) const;

  int width_, height_;
  Lens lens_;
  Settings settings_;
  Lighting lighting_;                // about the origin of the world
  std::vector<light_def_t> lamps_;  // of lighting_
  Appearance appearance_;
  std::vector<Triangles> geometries_;
  std::map<std::int64_t, int> mesh_geometry_;
  std::vector<Relief> reliefs_;
  std::vector<int> relief_of_material_;
  std::vector<ShapePart> parts_;
  struct Tool {
    int body;
    ShapePart ghost;
    int light = -1;       // index of the light that it steers
    bool hidden = false;  // the user's own head is not drawn
    light_def_t lamp{};
  };
  std::vector<Tool> tools_;
  std::vector<std::string> warnings_;
  std::vector<Eigen::Vector4f> tints_;
};

}  // namespace tactus::visual
