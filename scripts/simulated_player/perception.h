// The percepts of a user, assembled from the output of the cluster: sight from the pictures and hearing from the sounds, at
// the time of their presentation, and touch from the force of the device. The degradations of a profile apply to them. Without
// a visual node there is no sight.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <tactus/node_health_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/world_state_t.hpp>
#include <vector>

#include "scripts/simulated_player/player.h"
#include "scripts/simulated_player/rules.h"
#include "sync/degradation/stage_signal.h"
#include "sync/resampling/body_history.h"
#include "sync/resampling/contact_stream.h"
#include "sync/node/modality_endpoint.h"

namespace tactus::simulated_player {

class Perception {
 public:
  // frame_rate_Hz: rate of the pictures. Throws std::runtime_error as sync::ModalityEndpoint does.
  Perception(sync::Node& node, Rules rules, double frame_rate_Hz);

  void set_scene(const scene_t& scene);
  // Call it once a tick. Sight and hearing at `now`; the caller adds the hand and the force on it.
  Percept perceive(sync::HostTime now);
  // Once a tick, after perceive(): the force that the participant perceives while the device exerts force_N on the hand, N, which
  // moves at speed_m_s. The
  // stage `percept` of a profile changes it; the arm moves under force_N itself.
  Eigen::Vector3d felt_N(sync::HostTime now, const Eigen::Vector3d& force_N, double speed_m_s);

 private:
  // True when a node renders that modality, or did so a moment ago.
  bool rendered(const std::string& modality, sync::HostTime now) const;
  void update_sight(sync::HostTime now);
  void update_hearing(sync::HostTime now, Percept& percept);

  Rules rules_;
  sync::ModalityEndpoint eyes_, ears_, hand_;
  sync::ModalityEndpoint::Stage& percept_;
  sync::StageSignal touch_;
  sync::Queue<node_health_t>& healths_;
  sync::ModalityEndpoint::Stream<world_state_t>& world_;
  sync::ModalityEndpoint::Events& events_;
  sync::BodyHistory bodies_;
  sync::ContactStream contacts_;
  double frame_rate_Hz_;
  std::uint64_t seed_;
  std::map<std::string, sync::HostTime> last_health_;  // newest health of the node that renders a modality, by modality
  sync::HostTime next_picture_{};
  std::vector<std::optional<Eigen::Vector3d>> visible_balls_m_;
  struct Sound {
    sync::HostTime at;
    std::size_t goal;
    bool falls;              // into its hole
    Eigen::Vector3d from_m;  // perceived place of the source
  };
  std::vector<Sound> sounds_;  // pending
};

}  // namespace tactus::simulated_player
