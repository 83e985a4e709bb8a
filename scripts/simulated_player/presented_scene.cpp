#include "scripts/simulated_player/presented_scene.h"

#include <cmath>
#include <numbers>
#include <tactus/contact_event_t.hpp>
#include <utility>

namespace tactus::simulated_player {
namespace {

using Eigen::Vector3d;

constexpr sync::Nanoseconds kSilent{300'000'000};        // a node that is silent for this time counts as stalled, as in sync_node
constexpr sync::Nanoseconds kAheadOfSound{20'000'000};   // events this far ahead are accepted, as in audio_node
constexpr sync::Nanoseconds kHandPeriod{2'000'000};      // of the stored places of the drawn hand
constexpr sync::Nanoseconds kHandStale{200'000'000};     // then the hand is not drawn, as in visual_node
constexpr std::size_t kMaxHands = 8192;                  // 16 s: the longest delay of a picture in which the hand is found
constexpr std::size_t kMaxSounds = 4096;                 // that wait; a newer one is dropped
constexpr double kPitDepth_m = 0.02;                     // the bottom of a hole lies at least this far below its rim (design)

sync::NodeDescriptor presenting_node(const char* node, const char* modality, int expected) {
  return {.name = node, .modality = modality, .expected_events = expected, .about = ""};
}

// Materials of the fixed shapes below the holes that the floor around them does not have.
std::set<int> materials_of_pits(const scene_t& scene, const Rules& rules) {
  std::set<int> pits, floors;
  for (const shape_def_t& shape : scene.shapes) {
    const body_def_t& body = scene.bodies[static_cast<std::size_t>(shape.body)];
    if (body.is_static == 0 || shape.kind != shape_def_t::BOX) continue;
    const Vector3d at(body.pose.position_m.x + shape.pose.position_m.x, body.pose.position_m.y + shape.pose.position_m.y,
                      body.pose.position_m.z + shape.pose.position_m.z);
    const Vector3d half = Vector3d(shape.size_m.x, shape.size_m.y, shape.size_m.z) / 2;
    for (const Goal& goal : rules.goals) {
      const bool below = ((goal.hole_m - at).head<2>().cwiseAbs() - half.head<2>()).maxCoeff() < 0;
      if (below && at.z() + half.z() < goal.hole_m.z() - kPitDepth_m) pits.insert(shape.material);
      if (std::abs(at.z() + half.z() - goal.hole_m.z()) < 1e-3) floors.insert(shape.material);
    }
  }
  for (const int material : floors) pits.erase(material);
  return pits;
}

}  // namespace

PresentedScene::PresentedScene(sync::Node& node, Rules rules, double frame_rate_Hz)
    : rules_(std::move(rules)),
      eyes_(node, presenting_node("visual_node", "visual", int{node_health_t::EXPECTS_BEGIN} | node_health_t::EXPECTS_HIT)),
      ears_(node, presenting_node("audio_node", "audio", node_health_t::EXPECTS_HIT)),
      hand_(node, presenting_node("participant", "haptic", 0)),
      percept_(hand_.stage("percept")),
      healths_(node.bus().queue<node_health_t>(channels::kNodeHealth, 256)),
      world_(eyes_.snapshots<world_state_t>(channels::kWorldState, 4096)),
      tools_(eyes_.snapshots<tool_state_t>(channels::kToolState, 512)),
      events_(ears_.events()),
      bodies_(node.bus().clocks()),
      contacts_(events_.inbox()),
      frame_rate_Hz_(frame_rate_Hz) {}

void PresentedScene::set_scene(const scene_t& scene) {
  eyes_.set_scene(scene), ears_.set_scene(scene), hand_.set_scene(scene);
  scene_ = scene;
  viewer_ = viewer_of(scene);
  occluders_.emplace(scene);
  dull_materials_ = materials_of_pits(scene, rules_);
}

void PresentedScene::receive(sync::HostTime now) {
  eyes_.step(now), ears_.step(now), hand_.step(now);
  bodies_.extend_history(eyes_.delay()), contacts_.extend_history(ears_.delay());
  while (const auto m = world_.pop()) bodies_.push(m->message, m->arrival);
  while (const auto m = tools_.pop()) {
    if (m->message.tool != 0 || (!drawn_hands_.empty() && m->arrival - drawn_hands_.back().arrival < kHandPeriod)) continue;
    const auto& p = m->message.proxy.position_m;
    drawn_hands_.push_back({m->arrival, {p.x, p.y, p.z}});
    if (drawn_hands_.size() > kMaxHands) drawn_hands_.pop_front();
  }
  eyes_.publish(now), ears_.publish(now);
  while (const auto m = healths_.pop())
    if (!m->message.modality.empty()) last_health_[m->message.modality] = m->arrival;
}

bool PresentedScene::rendered(const std::string& modality, sync::HostTime now) const {
  const auto at = last_health_.find(modality);
  return at != last_health_.end() && now - at->second < kSilent;
}

double PresentedScene::picture_delay_s() const {
  const double slow_Hz = eyes_.output().value("frame_rate");
  return sync::to_seconds(eyes_.delay()) + 0.5 / (slow_Hz > 0 ? slow_Hz : frame_rate_Hz_);
}

// The picture draws the newest hand. A delay of the profile holds the whole picture back.
std::optional<Vector3d> PresentedScene::drawn_hand_m(sync::HostTime now) const {
  const sync::HostTime drawn = now - eyes_.profile_delay();
  for (auto hand = drawn_hands_.rbegin(); hand != drawn_hands_.rend(); ++hand)
    if (hand->arrival <= drawn) return drawn - hand->arrival < kHandStale ? std::optional(hand->at_m) : std::nullopt;
  return std::nullopt;
}

Eigen::Isometry3d PresentedScene::pose(int body, sync::SimTime t) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const auto sample = bodies_.pose(body, t);
  if (sample.status != sync::SampleStatus::kNone) {
    pose.translation() = sample.value.position;
    pose.linear() = sample.value.orientation.toRotationMatrix();
    return pose;
  }
  const pose_t& first = scene_.bodies[static_cast<std::size_t>(body)].pose;
  pose.translation() = Vector3d(first.position_m.x, first.position_m.y, first.position_m.z);
  const Eigen::Quaterniond q(first.orientation.w, first.orientation.x, first.orientation.y, first.orientation.z);
  if (q.norm() > 0) pose.linear() = q.normalized().toRotationMatrix();
  return pose;
}

double PresentedScene::visible_px(std::size_t goal, const Vector3d& at_m) const {
  if (!occluders_) return 0;
  const Goal& ball = rules_.goals[goal];
  const double factor = eyes_.output().value("resolution"), scale = factor > 0 ? factor : 1;
  const double distance_m = std::max((at_m - viewer_.eye_m).norm(), 1e-3), radius_px = scale * viewer_.focal_px * ball.ball_radius_m / distance_m;
  const double share = occluders_->visible_share(viewer_.eye_m, at_m, ball.ball_radius_m, ball.body, [this](int body) { return pose(body, shown_); });
  return share * std::numbers::pi * radius_px * radius_px;
}

std::optional<Picture> PresentedScene::picture(sync::HostTime now, sync::HostTime start) {
  if (now < next_picture_) return std::nullopt;
  const double slow_Hz = eyes_.output().value("frame_rate");
  Picture picture;
  picture.interval_s = 1 / (slow_Hz > 0 ? slow_Hz : frame_rate_Hz_);
  next_picture_ = now + sync::from_seconds(picture.interval_s);
  const auto map = bodies_.map(now);
  if (!map || !rendered("visual", now)) return std::nullopt;
  picture.shown_s = sync::to_seconds(now - start);
  picture.hand_m = drawn_hand_m(now);
  shown_ = map->to_sim(now - eyes_.delay());
  for (std::size_t i = 0; i < rules_.goals.size(); ++i) {
    picture.balls.emplace_back();
    const auto sample = bodies_.pose(rules_.goals[i].body, shown_);
    if (sample.status == sync::SampleStatus::kNone || sample.status == sync::SampleStatus::kStale) continue;
    picture.balls.back() = Picture::Ball{sample.value.position, visible_px(i, sample.value.position)};
  }
  return picture;
}

std::vector<Sound> PresentedScene::sounds(sync::HostTime now, sync::HostTime start) {
  if (const auto map = contacts_.map(now))
    for (const contact_event_t& e : contacts_.take_events(map->to_sim(now + kAheadOfSound))) {
      if (e.kind != contact_event_t::HIT || pending_.size() >= kMaxSounds) continue;
      const sync::HostTime at = ears_.schedule(e.event_id, map->to_host(sync::sim_time(e.time_ns)));
      const bool dull = dull_materials_.contains(e.material_a) || dull_materials_.contains(e.material_b);
      pending_.push_back({at, {sync::to_seconds(at - start), static_cast<std::uint64_t>(e.event_id), {e.point_m.x, e.point_m.y, e.point_m.z}, dull}});
    }
  if (!rendered("audio", now)) pending_.clear();
  std::vector<Sound> presented;
  std::erase_if(pending_, [&](const PendingSound& p) {
    if (p.at > now) return false;
    presented.push_back(p.sound);
    return true;
  });
  return presented;
}

Vector3d PresentedScene::felt_N(sync::HostTime now, const Vector3d& force_N, double speed_m_s) {
  const auto map = bodies_.map(now);
  sync::ForceSample sample;
  sample.force_N = force_N;
  sample.speed_m_s = speed_m_s;
  const Vector3d felt = touch_.step(now, map ? map->to_sim(now) : sync::SimTime{}, sample, percept_.operators, &percept_.decisions).force_N;
  hand_.publish(now);
  return felt;
}

}  // namespace tactus::simulated_player
