// The observer player on the bus: number N of a population, with its arm.
#include <optional>
#include <utility>

#include "scripts/simulated_player/observer/impedance_arm.h"
#include "scripts/simulated_player/observer/population.h"
#include "scripts/simulated_player/observer_player.h"
#include "scripts/simulated_player/player_body.h"
#include "scripts/simulated_player/presented_scene.h"
#include "sync/random/keyed_random.h"

namespace tactus::simulated_player {
namespace {

constexpr std::uint64_t kObserverStream = 131;

class ObserverBody : public PlayerBody {
 public:
  ObserverBody(sync::Node& node, const Rules& rules, const BodyDef& def)
      : rules_(rules),
        def_(def),
        parameters_(def.choice.number < 0 ? observer::PlayerParameters{}
                                          : observer::player_of(static_cast<std::uint32_t>(def.choice.number), def.population_seed)),
        seed_(sync::mixed(sync::mixed(sync::mixed(def.population_seed, kObserverStream), static_cast<std::uint64_t>(def.choice.number + 1)),
                          node.options().seed)),
        presented_(node, rules, def.frame_rate_Hz),
        arm_(parameters_, def.rest_m, seed_) {}

  void set_scene(const scene_t& scene) override {
    presented_.set_scene(scene);
    // A restart of the world continues the game with the beliefs so far.
    if (player_) return;
    player_.emplace(parameters_, rules_, presented_.viewer(),
                    [this](std::size_t goal, const Eigen::Vector3d& at_m) { return presented_.visible_px(goal, at_m); }, arm_.position_m(), seed_);
  }
  void step(const Tick& tick) override {
    presented_.receive(tick.now);
    if (!start_ && player_ && tick.has_scene) start_ = tick.now;
    const sync::HostTime start = start_.value_or(tick.now);
    const auto picture = presented_.picture(tick.now, start);
    const auto sounds = presented_.sounds(tick.now, start);
    const Eigen::Vector3d felt_N = presented_.felt_N(tick.now, tick.force_N);
    if (!player_) return;
    const bool runs = tick.has_scene && !tick.in_setup;
    if (runs && !std::exchange(began_, true))
      player_->beliefs().practise(def_.practice, presented_.picture_delay_s(), presented_.sound_delay_s(), 0);
    if (runs && picture) player_->senses().show(*picture, player_->gaze_m());
    if (runs)
      for (const Sound& sound : sounds) player_->senses().play(sound);
    const Eigen::Vector3d command_N = player_->step(sync::to_seconds(tick.now - start), arm_.position_m(), felt_N, runs);
    if (runs) arm_.step(command_N, tick.force_N, tick.dt_s);
  }
  Eigen::Vector3d position_m() const override { return arm_.position_m(); }
  Eigen::Vector3d velocity_m_s() const override { return arm_.velocity_m_s(); }
  int goal() const override { return player_ ? player_->goal() : 0; }
  int action() const override { return player_ ? static_cast<int>(player_->action()) : 0; }

 private:
  Rules rules_;
  BodyDef def_;
  observer::PlayerParameters parameters_;
  std::uint64_t seed_;
  PresentedScene presented_;
  observer::ImpedanceArm arm_;
  std::optional<ObserverPlayer> player_;
  std::optional<sync::HostTime> start_;
  bool began_ = false;
};

}  // namespace

std::unique_ptr<PlayerBody> make_observer_body(sync::Node& node, const Rules& rules, const BodyDef& def) {
  return std::make_unique<ObserverBody>(node, rules, def);
}

}  // namespace tactus::simulated_player
