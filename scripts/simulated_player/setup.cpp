#include "scripts/simulated_player/setup.h"

#include <algorithm>
#include <tactus/body_def_t.hpp>
#include <tactus/sim_reply_t.hpp>

#include "lcmtypes/channels.h"
#include "sync/random/keyed_random.h"

namespace tactus::simulated_player {
namespace {

constexpr sync::Nanoseconds kRepeat{50'000'000};  // a datagram may be lost
constexpr std::uint64_t kPlacesStream = 11, kCommandIdStream = 12;

double symmetric_uniform(double half, std::uint64_t seed, std::uint64_t key) { return half * (2 * sync::uniform(seed, key) - 1); }

}  // namespace

std::vector<Eigen::Vector3d> places(const Rules& rules, const scene_t& scene, const Scatter& scatter, std::uint64_t seed) {
  std::vector<Eigen::Vector3d> places;
  const std::uint64_t own = sync::mixed(seed, kPlacesStream);
  for (std::size_t i = 0; i < rules.goals.size(); ++i) {
    const Goal& goal = rules.goals[i];
    const auto& at = scene.bodies[static_cast<std::size_t>(goal.body)].pose.position_m;
    const Eigen::Vector3d begin(at.x, at.y, 0), hole(goal.hole_m.x(), goal.hole_m.y(), 0);
    const Eigen::Vector3d along = (hole - begin).normalized(), aside(-along.y(), along.x(), 0);
    places.push_back(begin + symmetric_uniform(scatter.along_m, own, 2 * i) * along + symmetric_uniform(scatter.aside_m, own, 2 * i + 1) * aside);
    places.back().z() = goal.hole_m.z() + goal.ball_radius_m;
  }
  return places;
}

Setup::Setup(sync::Bus& bus, const scene_t& scene, const Rules& rules, const std::vector<Eigen::Vector3d>& places, std::uint64_t seed)
    : bus_(bus) {
  for (std::size_t i = 0; i < rules.goals.size(); ++i) {
    const body_def_t& ball = scene.bodies[static_cast<std::size_t>(rules.goals[i].body)];
    sim_command_t c{};
    c.header.sim_time_ns = -1;
    c.id = static_cast<std::int64_t>(sync::mixed(sync::mixed(seed, kCommandIdStream), i) >> 2) + 1;
    c.kind = sim_command_t::SET;
    c.name = ball.name;
    c.property = "pose";
    c.values = {places[i].x(), places[i].y(), places[i].z(), 0, 0, 0};
    c.count = static_cast<std::int8_t>(c.values.size());
    commands_.push_back(c);
  }
}

void Setup::step(sync::HostTime now, sync::Queue<sim_reply_t>& replies) {
  while (const auto m = replies.pop())
    if (m->message.header.run_id == bus_.identity().run_id)
      std::erase_if(commands_, [&](const sim_command_t& c) { return c.id == m->message.id; });
  if (commands_.empty() || now < next_) return;
  next_ = now + kRepeat;
  for (sim_command_t& c : commands_) bus_.publish(channels::kSimCommand, c);
}

}  // namespace tactus::simulated_player
