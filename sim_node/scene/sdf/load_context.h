// Context of the scene loader: the world under construction, and error and warning messages for an element.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "sim_node/model/world_def.h"
#include "sim_node/scene/sdf/element.h"
#include "sim_node/scene/sdf/frames.h"
#include "sim_node/scene/sdf/sdf_files.h"
#include "sync/pictures/confined_pictures.h"

namespace tactus::sim {

struct MeshParts;
struct LookAttributes;

struct LoadContext {
  const SdfFiles& files;
  sdf::Frames& frames;
  std::vector<std::string>& warnings;
  WorldDef& world;
  bool confined = true;                    // geometry files are read in a process of their own
  std::map<std::string, int> body_of = {};      // scoped name -> index
  std::unordered_map<const sdf::Element*, int> body_of_link = {};
  std::map<std::string, int> mesh_of = {};      // file, submesh and scale -> index
  std::size_t mesh_corners = 0;                 // of all meshes
  std::map<std::string, int> material_of = {};  // name -> index
  const sdf::Element* camera_sensor = nullptr;  // the first one found: used when the scene names no camera
  Eigen::Isometry3d camera_sensor_pose = Eigen::Isometry3d::Identity();
  std::map<std::string, std::shared_ptr<const MeshParts>> mesh_files = {};    // each file once
  std::map<std::string, int> material_of_file = {};                           // of a mesh file that names one
  std::map<std::string, std::shared_ptr<const LookAttributes>> look_of = {};  // name -> definition in <world>
  std::unordered_map<std::string, int> look_index_of = {};                    // content -> index
  std::unordered_map<std::string, std::int64_t> picture_of_file = {};         // file and use -> hash
  std::set<std::size_t> placeholders = {};  // visuals that stand for a mesh that is not there
  sync::ConfinedPictures pictures = {};

  // "FILE:LINE: PATH sentence"
  [[noreturn]] void reject(const sdf::Element& element, const std::string& sentence) const;
  void warn(const sdf::Element& element, const std::string& sentence) const;

  // The file of a mesh, picture or table that an element names; rejects a missing file, and one outside the readable
  // folders.
  std::filesystem::path asset_file(const std::string& uri, const sdf::Element& element) const;

  // The pose of a model, link, joint or frame in the model or world that contains it; of another element in its link or
  // world. Rejects a pose that is not finite, or far away.
  Eigen::Isometry3d resolve(const sdf::Element& element) const;
};

}  // namespace tactus::sim
