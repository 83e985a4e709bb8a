// From contacts that slide to what is heard of them: which surface wears a map, where on it, how fast. Pure.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <tactus/contact_t.hpp>
#include <tactus/scene_t.hpp>
#include <vector>

#include "audio_node/impact.h"
#include "audio_node/scrape.h"
#include "audio_node/settings.gen.h"
#include "lcmtypes/friction_map.h"
#include "sync/contact_stream.h"
#include "sync/scene_exchange.h"

namespace tactus::audio {

using HeightMaps = std::map<std::int64_t, HeightMap>;  // by content hash
using Pictures = std::map<std::int64_t, sync::Bytes>;
// The pictures of relief and friction that the materials of a scene name, as far as they were sent. It copies
// them.
Pictures pictures_of(const sync::SceneReceiver& scenes);
// Reads them, which may take as long as a second: not for a loop. What cannot be read is left out, and smooth.
std::unique_ptr<HeightMaps> read_maps(const Pictures& pictures);

// Reliefs that the callback may still read: none goes before the process does. By picture, extents and height.
class HeardReliefs {
 public:
  const Relief* get(const material_def_t& material, const HeightMap& map);

 private:
  std::map<std::tuple<std::int64_t, double, double, double>, std::unique_ptr<const Relief>> reliefs_;
};

// Of one scene. Surfaces of bodies that stand still and wear a relief or a friction map scrape; all others are
// silent.
class Sliding {
 public:
  // maps: the pictures of the scene by their hash; those that are not there are smooth. reliefs: outlives the
  // callback.
  Sliding(const scene_t& scene, const HeightMaps& maps, HeardReliefs& reliefs, const Settings& settings);

  // T_world_listener from the next contacts on; at first the scene's.
  void hear_from(const Eigen::Isometry3d& listener) { listener_ = listener; }

  // False: no surface of the scene can be heard so, and nobody need look at contacts.
  bool any() const { return any_; }
  // What of the contacts of an instant is to be heard at `at`. dt_s: since the instant before.
  const std::vector<Scrape>& scrapes(const sync::Contacts& contacts, sync::HostTime at, double dt_s);

 private:
  struct Material {
    const Relief* relief = nullptr;
    std::shared_ptr<const FrictionMap> friction;
    double mu = 0.5;  // of the surface, sliding
    bool heard() const { return relief || friction; }
  };
  struct Way {
    double travelled_m = 0;
    bool seen = false;
  };
  const Material* heard(std::int32_t body, std::int32_t material) const;

  Settings settings_;
  Eigen::Isometry3d listener_;
  std::vector<Material> materials_;
  bool any_ = false;
  std::map<std::int32_t, Eigen::Quaterniond> standing_;  // bodies that never move
  std::map<std::int64_t, Way> ways_;                     // of the contacts that slide
  std::vector<Scrape> out_;
};

}  // namespace tactus::audio
