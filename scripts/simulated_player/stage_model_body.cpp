// The player of fixed rules, "stage_model", on the bus.
#include "scripts/simulated_player/arm.h"
#include "scripts/simulated_player/perception.h"
#include "scripts/simulated_player/player_body.h"

namespace tactus::simulated_player {
namespace {

class StageModelBody : public PlayerBody {
 public:
  StageModelBody(sync::Node& node, const Rules& rules, const BodyDef& def)
      : balls_(rules.goals.size()), perception_(node, rules, def.frame_rate_Hz), player_(rules, def.stage_model), arm_({}, def.rest_m, node.options().seed) {}

  void set_scene(const scene_t& scene) override { perception_.set_scene(scene); }
  void step(const Tick& tick) override {
    Percept percept = perception_.perceive(tick.now);
    percept.force_N = perception_.felt_N(tick.now, tick.force_N, arm_.velocity_m_s().norm());
    percept.hand_m = arm_.position_m();
    if (tick.in_setup)
      percept.balls_m.assign(balls_, std::nullopt);  // sight is off before the game begins
    else if (tick.has_scene)
      arm_.step(player_.step(percept), tick.force_N, tick.dt_s);
  }
  Eigen::Vector3d position_m() const override { return arm_.position_m(); }
  Eigen::Vector3d velocity_m_s() const override { return arm_.velocity_m_s(); }
  int goal() const override { return player_.goal(); }
  int action() const override { return static_cast<int>(player_.action()); }

 private:
  std::size_t balls_;
  Perception perception_;
  Player player_;
  Arm arm_;
};

}  // namespace

std::unique_ptr<PlayerBody> make_player_body(sync::Node& node, const Rules& rules, const BodyDef& def) {
  if (def.choice.observer) return make_observer_body(node, rules, def);
  return std::make_unique<StageModelBody>(node, rules, def);
}

}  // namespace tactus::simulated_player
