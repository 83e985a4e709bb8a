#include "scripts/simulated_player/perception.h"

#include <tactus/contact_event_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/world_state_t.hpp>
#include <utility>

#include "sync/random/keyed_random.h"

namespace tactus::simulated_player {
namespace {

// The nodes whose output is observed: visual_node and audio_node.
sync::NodeDescriptor observed_node(const char* node, const char* modality, int expected) {
  return {.name = node, .modality = modality, .expected_events = expected, .about = ""};
}

// A ball that hits an object this far below the rim lies in the hole (design: a third of the shallowest ball).
constexpr double kInHoleDepth_m = 0.02;
constexpr sync::Nanoseconds kHealthTimeout{
    300'000'000};  // a node that is silent for this time counts as stalled, as in sync_node
// Uncertainty of the direction and distance of a sound source, standard deviation. A still head resolves 3.6 degrees to the
// side (Blauert 1997, Spatial Hearing, section 2.1): 7 cm at the eye's distance from the floor. Design choice: a slightly
// smaller value, also for the distance, because an audible ball lies on the floor and the head moves.
constexpr double kLocalizationSd_m = 0.05;
constexpr std::uint64_t kHearingStream = 13;     // random stream of the seed
constexpr sync::Nanoseconds kEarly{20'000'000};  // events this far ahead are accepted, as in audio_node

}  // namespace

Perception::Perception(sync::Node& node, Rules rules, double frame_rate_Hz)
    : rules_(std::move(rules)),
      eyes_(node, observed_node("visual_node", "visual", int{node_health_t::EXPECTS_BEGIN} | node_health_t::EXPECTS_HIT)),
      ears_(node, observed_node("audio_node", "audio", node_health_t::EXPECTS_HIT)),
      hand_(node, observed_node("participant", "haptic", 0)),
      percept_(hand_.stage("percept")),
      healths_(node.bus().queue<node_health_t>(channels::kNodeHealth, 256)),
      world_(eyes_.snapshots<world_state_t>(channels::kWorldState, 4096)),
      events_(ears_.events()),
      bodies_(node.bus().clocks()),
      contacts_(events_.inbox()),
      frame_rate_Hz_(frame_rate_Hz),
      seed_(sync::mixed(node.options().seed, kHearingStream)),
      visible_balls_m_(rules_.goals.size()) {}

void Perception::set_scene(const scene_t& scene) {
  eyes_.set_scene(scene);
  ears_.set_scene(scene);
  hand_.set_scene(scene);
}

Percept Perception::perceive(sync::HostTime now) {
  eyes_.step(now), ears_.step(now), hand_.step(now);
  bodies_.extend_history(eyes_.delay()), contacts_.extend_history(ears_.delay());
  while (const auto m = world_.pop()) bodies_.push(m->message, m->arrival);
  eyes_.publish(now), ears_.publish(now);
  while (const auto m = healths_.pop())
    if (!m->message.modality.empty()) last_health_[m->message.modality] = m->arrival;
  if (now >= next_picture_) update_sight(now);
  Percept percept;
  percept.time_s = sync::to_seconds(now.time_since_epoch());
  percept.balls_m = visible_balls_m_;
  update_hearing(now, percept);
  return percept;
}

Eigen::Vector3d Perception::felt_N(sync::HostTime now, const Eigen::Vector3d& force_N, double speed_m_s) {
  const auto map = bodies_.map(now);
  sync::ForceSample sample;
  sample.force_N = force_N;
  sample.speed_m_s = speed_m_s;
  const Eigen::Vector3d felt =
      touch_.step(now, map ? map->to_sim(now) : sync::SimTime{}, sample, percept_.operators, &percept_.decisions).force_N;
  hand_.publish(now);
  return felt;
}

bool Perception::rendered(const std::string& modality, sync::HostTime now) const {
  const auto at = last_health_.find(modality);
  return at != last_health_.end() && now - at->second < kHealthTimeout;
}

// A picture shows the world at its presentation delay, and stays until the next.
void Perception::update_sight(sync::HostTime now) {
  const double slow_Hz = eyes_.output().value("frame_rate");
  next_picture_ = now + sync::from_seconds(1 / (slow_Hz > 0 ? slow_Hz : frame_rate_Hz_));
  const auto map = bodies_.map(now);
  for (std::size_t i = 0; i < visible_balls_m_.size(); ++i) {
    visible_balls_m_[i].reset();
    if (!map || !rendered("visual", now)) continue;
    const auto pose = bodies_.pose(rules_.goals[i].body, map->to_sim(now - eyes_.delay()));
    // A stale picture is not used.
    if (pose.status != sync::SampleStatus::kNone && pose.status != sync::SampleStatus::kStale) visible_balls_m_[i] = pose.value.position;
  }
}

void Perception::update_hearing(sync::HostTime now, Percept& percept) {
  if (const auto map = contacts_.map(now))
    for (const contact_event_t& e : contacts_.take_events(map->to_sim(now + kEarly)))
      for (std::size_t i = 0; i < rules_.goals.size(); ++i) {
        const Goal& goal = rules_.goals[i];
        if (e.kind != contact_event_t::HIT || e.tool >= 0 || (e.body_a != goal.body && e.body_b != goal.body))
          continue;
        const bool falls = e.point_m.z < goal.hole_m.z() - kInHoleDepth_m - goal.ball_radius_m;
        const auto off = [&](std::uint64_t axis) {
          return kLocalizationSd_m *
                 sync::normal_quantile(sync::uniform(seed_, 2 * static_cast<std::uint64_t>(e.event_id) + axis));
        };
        const Eigen::Vector3d from(e.point_m.x + off(0), e.point_m.y + off(1), e.point_m.z);
        sounds_.push_back({ears_.schedule(e.event_id, map->to_host(sync::sim_time(e.time_ns))), i, falls, from});
      }
  if (!rendered("audio", now)) sounds_.clear();
  percept.fell.assign(rules_.goals.size(), false);
  percept.heard_m.assign(rules_.goals.size(), std::nullopt);
  std::erase_if(sounds_, [&](const Sound& sound) {
    if (sound.at > now) return false;
    if (sound.falls)
      percept.fell[sound.goal] = true;
    else
      percept.heard_m[sound.goal] = sound.from_m;
    return true;
  });
}

}  // namespace tactus::simulated_player
