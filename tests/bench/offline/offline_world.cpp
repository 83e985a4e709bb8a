// Steps of the simulation and the hands on simulated time, and the log of their messages.
#include "tests/bench/offline/offline_world.h"

#include <chrono>
#include <stdexcept>
#include <tactus/asset_ref_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sim_node/scene/scene_assets.h"
#include "sync/bus/decode.h"
#include "tests/haptic_node/support/node_config.h"

namespace tactus::bench {

scene_t scene_of(const sim::WorldDef& world, sync::Nanoseconds step) {
  for (const sync::Asset& asset : sim::make_assets(world, step.count()))
    if (asset.kind == asset_ref_t::SCENE)
      if (auto scene = sync::decode_asset<scene_t>(asset.bytes)) return *scene;
  throw std::runtime_error("simulation_bench: the world has no scene asset");
}

OfflineWorld::OfflineWorld(const sim::WorldDef& world, const sim::Settings& settings, bool hands,
                           std::unique_ptr<sync::LogSink> log)
    : scene_(scene_of(world, sync::from_seconds(settings.step_s))),
      simulation_(world, settings),
      bus_(sync::Identity{"sim_node", 1, 99, kRun, kClock}, {.memory = true}),
      touch_(bus_.queue<touch_model_t>(channels::kTouchModel, 64)),
      events_(bus_.queue<contact_events_t>(channels::kContactEvents, 256)),
      contacts_(bus_.queue<contact_frame_t>(channels::kContacts, 4096)),
      bodies_(bus_.queue<world_state_t>(channels::kWorldState, 4096)),
      publisher_(bus_, settings.state_rate_Hz, settings.page_budget,
                 static_cast<std::size_t>(settings.event_pages), sync::from_seconds(settings.step_s)) {
  if (log) log_ = std::make_unique<sync::LogWriter>(std::move(log));
  simulation_.start(99);
  hand_forces_N_.resize(hands ? scene_.tools.size() : 0, Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < hand_forces_N_.size(); ++i) {
    const haptic::NodeConfig choice = haptic::resolve_config(scene_, scene_.tools[i].name, {});
    auto hand = std::make_unique<Hand>(Hand{haptic::Safety(haptic::safety_limits(choice.settings)), nullptr});
    hand->session = std::make_unique<haptic::Session>(scene_, choice, haptic::make_tool_device(scene_, choice),
                                                      sync::OwnClock(kRun, kClock), hand->safety);
    hands_.push_back(std::move(hand));
  }
}

void OfflineWorld::note(const char* channel, std::span<const std::uint8_t> bytes) {
  const auto now = world_map().to_host(simulation_.now());
  if (log_) log_->write(sync::to_ns(now) / 1000, channel, bytes);
}

// Messages of this step get the simulated instant as send time; the wall clock is not used.
template <class Message, class Deliver>
void OfflineWorld::collect(const char* channel, sync::Queue<Message>& queue, Deliver&& deliver) {
  while (auto m = queue.pop()) {
    m->message.header.publish_time_ns = sync::to_ns(world_map().to_host(simulation_.now()));
    note(channel, sync::encode(m->message));
    deliver(m->message);
  }
}

void OfflineWorld::publish() {
  publisher_.publish(
      {.time = simulation_.now(),
       .touch_models = &simulation_.touch_models(),
       .events = &simulation_.events(),
       .tool_contacts = &simulation_.tool_contacts(),
       .state = {simulation_.bodies(), [&](auto& out) { simulation_.body_contacts(out); }, simulation_.look_ahead()},
       .game = &simulation_.game()},
      world_map());
  const sync::HostTime now = world_map().to_host(simulation_.now());
  bus_.drain(now);
  const auto to_hands = [&](const auto& m) {
    for (auto& hand : hands_) hand->session->push(m, now);
  };
  collect(channels::kTouchModel, touch_, to_hands);
  collect(channels::kContactEvents, events_, [&](const contact_events_t& m) {
    for (auto& hand : hands_) hand->events.push(m, now), hand->session->push(hand->events.take(sync::SimTime::max()));
  });
  collect(channels::kContacts, contacts_, [](const auto&) {});
  collect(channels::kWorldState, bodies_, [](const auto&) {});
}

void OfflineWorld::step() {
  const auto begin = std::chrono::steady_clock::now();
  simulation_.step(news_);
  step_us_ = std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
  publish();
  news_.clear();
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    Hand& hand = *hands_[i];
    haptic::TickOutput& out = hand.session->step(world_map().to_host(simulation_.now()));
    header_t& h = out.state.header;
    h.publish_time_ns = sync::to_ns(world_map().to_host(simulation_.now()));
    h.run_id = kRun;
    h.clock = kClock;
    h.source = static_cast<std::int32_t>(10 + i);
    h.incarnation = static_cast<std::int64_t>(40 + i);
    h.seq = hand.seq++;
    hand_forces_N_[i] = out.force_N;
    felt_.insert(felt_.end(), out.reports.begin(), out.reports.end());
    news_.push_back(out.state);
    note(channels::kToolState, sync::encode(out.state));
  }
}

}  // namespace tactus::bench
