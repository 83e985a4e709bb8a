// A simulated player on the bus: the arm of one player, its percepts and its decisions. The program `simulated_player`
// drives one of them (run.cpp).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <tactus/scene_t.hpp>

#include "scripts/simulated_player/player.h"
#include "scripts/simulated_player/player_choice.h"
#include "scripts/simulated_player/rules.h"
#include "sync/node/node.h"

namespace tactus::simulated_player {

struct BodyDef {
  double frame_rate_Hz = 60;  // of the pictures
  PlayerDef stage_model{};
  PlayerChoice choice{};
  std::uint64_t population_seed = 1;  // of the players of the observer library
  int practice = 0;                   // pairs of action and effect that an observer experienced before the game
  Eigen::Vector3d rest_m{0, 0, 0};    // of the hand before the world begins
};

class PlayerBody {
 public:
  virtual ~PlayerBody() = default;
  virtual void set_scene(const scene_t& scene) = 0;
  // The state of hand and game in this tick.
  struct Tick {
    sync::HostTime now{};
    double dt_s = 0;                   // at most 2 ms
    Eigen::Vector3d force_N{0, 0, 0};  // of the device on the hand
    bool has_scene = false;
    bool in_setup = false;  // the balls are being placed: there is no sight, and the hand rests
  };
  virtual void step(const Tick& tick) = 0;
  virtual Eigen::Vector3d position_m() const = 0;
  virtual Eigen::Vector3d velocity_m_s() const = 0;
  virtual int goal() const = 0;
  virtual int action() const = 0;
};

// Throws std::runtime_error as sync::ModalityEndpoint does.
std::unique_ptr<PlayerBody> make_player_body(sync::Node& node, const Rules& rules, const BodyDef& def);
std::unique_ptr<PlayerBody> make_observer_body(sync::Node& node, const Rules& rules, const BodyDef& def);

}  // namespace tactus::simulated_player
