// From contacts that slide to what is heard of them: which surface wears a map, where on it, how fast. Pure.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <optional>
#include <tactus/contact_t.hpp>
#include <tactus/scene_t.hpp>
#include <vector>

#include "audio_node/heard_surfaces.h"
#include "audio_node/impact.h"
#include "audio_node/scrape.h"
#include "audio_node/settings.gen.h"
#include "sync/body_history.h"
#include "sync/contact_stream.h"

namespace tactus::audio {

// Of one scene. Surfaces that wear a relief or a friction map scrape, on bodies that stand still and on those that
// move; all others are silent.
class Sliding {
 public:
  // surfaces: of that scene, not null. bodies: how those that move are turned; outlives this.
  Sliding(const scene_t& scene, std::shared_ptr<const HeardSurfaces> surfaces, const sync::BodyHistory& bodies,
          const Settings& settings);

  // T_world_listener from the next contacts on; at first the scene's.
  void hear_from(const Eigen::Isometry3d& listener) { listener_ = listener; }

  // False: no surface of the scene can be heard so, and nobody need look at contacts.
  bool any() const { return surfaces_->any(); }
  // What of the contacts of the instant t is to be heard at `at`. dt_s: since the instant before.
  const std::vector<Scrape>& scrapes(const sync::Contacts& contacts, sync::SimTime t, sync::HostTime at,
                                     double dt_s);

 private:
  // The side of a contact that wears what is heard.
  struct Side {
    const HeardSurface* surface;
    Eigen::Quaterniond to_body;
    double mu, other_mu;  // sliding, without maps
    bool is_a;
  };
  // Of a contact, as long as it slides.
  struct Way {
    double travelled_m = 0;
    std::optional<Eigen::Vector3d> place;  // told last, in the body that wears the map
    double slid_m = 0, slid_s = 0;         // since another was told
    double share = 1;                      // of the sliding that was a way over the map, lately
    bool seen = false;
  };
  std::optional<Side> side(const contact_t& contact, bool is_a, sync::SimTime t) const;
  static double share(Way& way, const Eigen::Vector3d& place, const Eigen::Vector3d& along);

  Settings settings_;
  Eigen::Isometry3d listener_;
  std::shared_ptr<const HeardSurfaces> surfaces_;
  const sync::BodyHistory& bodies_;
  std::vector<double> mu_;                               // by material
  std::map<std::int32_t, Eigen::Quaterniond> standing_;  // bodies that never move, of which nobody tells often
  std::map<std::int64_t, Way> ways_;
  std::vector<Scrape> out_;
};

}  // namespace tactus::audio
