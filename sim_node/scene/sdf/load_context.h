// Context of the scene loader: the world under construction, and error and warning messages for an element.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <sdf/Element.hh>
#include <sdf/SemanticPose.hh>

#include "sim_node/scene/sdf/sdf_files.h"
#include "sim_node/model/world_def.h"
#include "sync/pictures/confined_pictures.h"

namespace tactus::sim {

struct MeshParts;
struct LookAttributes;

struct LoadContext {
  const SdfFiles& files;
  std::vector<std::string>& warnings;
  WorldDef& world;
  std::map<std::string, int> body_of;      // scoped name -> index
  std::map<std::string, int> mesh_of;      // file, submesh and scale -> index
  std::map<std::string, int> material_of;  // name -> index
  sdf::ElementPtr camera_sensor;           // the first one found: used when the scene names no camera
  Eigen::Isometry3d camera_sensor_pose = Eigen::Isometry3d::Identity();
  std::map<std::string, std::shared_ptr<const MeshParts>> mesh_files = {};  // each file once
  std::map<std::string, int> material_of_file = {};                         // of a mesh file that names one
  std::map<std::string, std::shared_ptr<const LookAttributes>> look_of = {};     // name -> definition in <world>
  bool confined = true;  // geometry files are read in a process of their own
  sync::ConfinedPictures pictures = {};

  // "FILE:LINE: sentence"
  [[noreturn]] void reject(const sdf::Element& element, const std::string& sentence) const;
  void warn(const sdf::Element& element, const std::string& sentence) const;

  // The file of a mesh, picture or table that an element names; rejects a missing file, and one outside the readable
  // folders.
  std::filesystem::path asset_file(const std::string& uri, const sdf::Element& element) const;

  // The pose resolved by libsdformat's frame graph; rejects a pose that is not finite.
  Eigen::Isometry3d resolve(const sdf::SemanticPose& pose, const sdf::Element& element,
                            const std::string& resolve_to = "") const;
};

// XML path in libsdformat's notation, also for elements that it does not know.
std::string xml_path(const sdf::Element& element);

// The first child of that name in the file, ignoring elements created as defaults.
sdf::ElementPtr explicit_child(const sdf::ElementPtr& element, const std::string& child);

}  // namespace tactus::sim
