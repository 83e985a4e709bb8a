// The senses of the observer player: presented pictures, sounds and forces become percepts with the noise, the missed things and
// the natural latencies of one person. The random numbers of a percept depend on player, game, sense and event alone, so that two
// conditions share them. Pure.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "scripts/simulated_player/observer/hearing.h"
#include "scripts/simulated_player/observer/noise_stream.h"
#include "scripts/simulated_player/observer/parameters.h"
#include "scripts/simulated_player/rules.h"
#include "scripts/simulated_player/viewer.h"

namespace tactus::simulated_player {

// Duration for which the noise levels of the population hold: one look (design, as in observer/pointing.cpp).
constexpr double kLookDuration_s = 0.1;
constexpr double kSampleStep_s = 0.01;  // of force, of the hand's place, and of the control

// A picture, as presented.
struct Picture {
  struct Ball {
    Eigen::Vector3d at_m{0, 0, 0};
    double visible_px = 0;  // area that the picture shows; 0: hidden
  };
  double shown_s = 0;
  double interval_s = 1.0 / 60;                   // until the next picture
  std::vector<std::optional<Ball>> balls{};       // one for each goal; nullopt: the picture is stale
  std::optional<Eigen::Vector3d> hand_m{};
};

// A sound, as presented.
struct Sound {
  double at_s = 0;
  std::uint64_t event = 0;
  Eigen::Vector3d from_m{0, 0, 0};
  bool dull = false;  // of the material at the bottom of a hole
};

struct SightPercept {
  struct Ball {
    Eigen::Vector3d point_m{0, 0, 0};       // on the perceived line of sight
    double sd_m = 0;                        // across it
    std::optional<Eigen::Vector2d> gap_m{};  // from the seen hand, along right and up of the line of sight
    double gap_sd_m = 0;
  };
  std::vector<std::optional<Ball>> balls{};  // nullopt: not noticed
  bool picture = false;                      // the eye looked at a picture that was not stale
  std::optional<Eigen::Vector3d> hand_m{};
  double hand_sd_m = 0, hand_depth_sd_m = 0;
};
struct SoundPercept {
  observer::SourcePlace place;
  bool dull = false;
};
struct ForcePercept {
  Eigen::Vector3d force_N{0, 0, 0};  // 0: below the floor
};
struct PlacePercept {
  Eigen::Vector3d hand_m{0, 0, 0};
  double sd_m = 0;
};

// Percepts by time of arrival: presentation plus latency. At most 4096 wait; the oldest is dropped first.
template <class Percept>
class LateQueue {
 public:
  void push(double arrival_s, Percept percept) {
    auto after = waiting_.end();
    while (after != waiting_.begin() && std::prev(after)->first > arrival_s) --after;
    waiting_.emplace(after, arrival_s, std::move(percept));
    if (waiting_.size() > 4096) waiting_.pop_front();
  }
  std::optional<std::pair<double, Percept>> take(double now_s) {
    if (waiting_.empty() || waiting_.front().first > now_s) return std::nullopt;
    auto next = std::move(waiting_.front());
    waiting_.pop_front();
    return next;
  }

 private:
  std::deque<std::pair<double, Percept>> waiting_;
};

class ObserverSenses {
 public:
  // seed: of player and game.
  ObserverSenses(const observer::PlayerParameters& player, const Rules& rules, const Viewer& viewer, std::uint64_t seed);

  // gaze_m: where the eye looks. Times: s since the start of the game.
  void show(const Picture& picture, const Eigen::Vector3d& gaze_m);
  void play(const Sound& sound);
  // Every kSampleStep_s: the force on the hand as the stage `percept` leaves it, N, and the hand's own place, m.
  void press(double at_s, const Eigen::Vector3d& force_N);
  void place_hand(double at_s, const Eigen::Vector3d& hand_m);

  LateQueue<SightPercept> sight;
  LateQueue<SoundPercept> hearing;
  LateQueue<ForcePercept> touch;
  LateQueue<PlacePercept> body;

 private:
  std::optional<SightPercept::Ball> look_at(const Picture& picture, std::size_t ball, const Eigen::Vector3d& gaze_m,
                                            observer::NoiseStream& noise) const;

  observer::PlayerParameters player_;
  Rules rules_;
  Viewer viewer_;
  std::uint64_t seed_;
  observer::NoiseStream touch_noise_, body_noise_;
  Eigen::Vector3d touch_state_{0, 0, 0};  // of magnitude, and of two turns of the direction
  Eigen::Vector3d bias_m_;                // of the felt place of the hand
};

}  // namespace tactus::simulated_player
