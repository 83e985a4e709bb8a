// The output of a cluster for an observer player, from the same streams and with the same decisions of the profile:
// pictures at their time with the visible area of each ball, sounds at their time, and the force of the stage `percept`. Without a
// visual or audio node there are no pictures or sounds.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tactus/node_health_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>
#include <vector>

#include "scripts/simulated_player/observer_senses.h"
#include "scripts/simulated_player/rules.h"
#include "scripts/simulated_player/viewer.h"
#include "sync/degradation/stage_signal.h"
#include "sync/node/modality_endpoint.h"
#include "sync/resampling/body_history.h"
#include "sync/resampling/contact_stream.h"

namespace tactus::simulated_player {

class PresentedScene {
 public:
  // frame_rate_Hz: rate of the pictures. Throws std::runtime_error as sync::ModalityEndpoint does.
  PresentedScene(sync::Node& node, Rules rules, double frame_rate_Hz);

  void set_scene(const scene_t& scene);
  // Once a tick: receives. Then, in any order, the picture and the sounds that are presented in this tick. start: zero of the times
  // of pictures and sounds.
  void receive(sync::HostTime now);
  std::optional<Picture> picture(sync::HostTime now, sync::HostTime start);
  std::vector<Sound> sounds(sync::HostTime now, sync::HostTime start);
  // The force that the participant perceives while the device exerts force_N, N, on the hand, which moves at speed_m_s.
  Eigen::Vector3d felt_N(sync::HostTime now, const Eigen::Vector3d& force_N, double speed_m_s);
  // Area, px, that the newest picture would show of a ball at this place; 0 before the first scene.
  double visible_px(std::size_t goal, const Eigen::Vector3d& at_m) const;
  // The delays of pictures and sounds now, beyond the instant of the world: for practice.
  double picture_delay_s() const;
  double sound_delay_s() const { return sync::to_seconds(ears_.delay()); }
  const Viewer& viewer() const { return viewer_; }

 private:
  bool rendered(const std::string& modality, sync::HostTime now) const;
  std::optional<Eigen::Vector3d> drawn_hand_m(sync::HostTime now) const;
  Eigen::Isometry3d pose(int body, sync::SimTime t) const;

  Rules rules_;
  sync::ModalityEndpoint eyes_, ears_, hand_;
  sync::ModalityEndpoint::Stage& percept_;
  sync::StageSignal touch_;
  sync::Queue<node_health_t>& healths_;
  sync::ModalityEndpoint::Stream<world_state_t>& world_;
  sync::ModalityEndpoint::Stream<tool_state_t>& tools_;
  sync::ModalityEndpoint::Events& events_;
  sync::BodyHistory bodies_;
  sync::ContactStream contacts_;
  double frame_rate_Hz_;
  std::map<std::string, sync::HostTime> last_health_;
  sync::HostTime next_picture_{};
  sync::SimTime shown_{};  // the instant of the world in the newest picture
  struct DrawnHand {
    sync::HostTime arrival;
    Eigen::Vector3d at_m;
  };
  std::deque<DrawnHand> drawn_hands_;  // at most kMaxHands, one each 2 ms
  scene_t scene_{};
  Viewer viewer_;
  std::optional<Occluders> occluders_;
  std::set<int> dull_materials_;
  struct PendingSound {
    sync::HostTime at;
    Sound sound;
  };
  std::vector<PendingSound> pending_;
};

}  // namespace tactus::simulated_player
