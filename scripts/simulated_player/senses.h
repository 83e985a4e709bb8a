// What the cluster's senses deliver to a person, put together: he sees what the pictures show, when they show it,
// and hears what sounds, when it sounds. Whatever a profile makes late, rare or silent comes so to him; and where
// nobody draws he sees nothing.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <tactus/contact_events_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/world_state_t.hpp>
#include <vector>

#include "scripts/simulated_player/player.h"
#include "scripts/simulated_player/rules.h"
#include "sync/resampling/body_history.h"
#include "sync/resampling/contact_stream.h"
#include "sync/node/modality_endpoint.h"

namespace tactus::participant {

class Senses {
 public:
  // Pictures come so often. Throws std::runtime_error as sync::Sense does.
  Senses(sync::Node& node, Rules rules, double frame_rate_Hz);

  void set_scene(const scene_t& scene);
  // Once a tick. What is seen and heard at `now`, for the player: his hand and the force on it are not of the bus
  // alone.
  Percept perceive(sync::HostTime now);

 private:
  // Somebody renders that sense, or did so a moment ago.
  bool rendered(const std::string& modality, sync::HostTime now) const;
  void look(sync::HostTime now);
  void listen(sync::HostTime now, Percept& percept);

  Rules rules_;
  sync::ModalityEndpoint eyes_, ears_;
  sync::Queue<node_health_t>& healths_;
  sync::ModalityEndpoint::Stream<world_state_t>& world_;
  sync::ModalityEndpoint::Stream<contact_events_t>& events_;
  sync::BodyHistory bodies_;
  sync::ContactStream contacts_;
  double frame_rate_Hz_;
  std::uint64_t seed_;
  std::map<std::string, sync::HostTime> heard_of_;  // who renders a sense, by modality
  sync::HostTime next_look_{};
  std::vector<std::optional<Eigen::Vector3d>> shown_;
  struct Sound {
    sync::HostTime at;
    std::size_t goal;
    bool falls;              // into its hole
    Eigen::Vector3d from_m;  // where it seems to come from
  };
  std::vector<Sound> sounds_;  // to come
};

}  // namespace tactus::participant
