#include "scripts/live/controls.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <tactus/header_t.hpp>

#include "lcmtypes/generation.h"
#include "lcmtypes/vectors.h"
#include "scripts/live/sliders.h"
#include "sync/bus/request_reply.h"
#include "sync/bus/identity.h"
#include "sync/text/printable.h"

namespace tactus::live {
namespace {

constexpr sync::Nanoseconds kRepeat{100'000'000};      // a datagram may be lost
constexpr sync::Nanoseconds kReplyTimeout{3'000'000'000};  // an answer comes with the next step
constexpr sync::Nanoseconds kProfileRepeatTime{2'000'000'000};   // as tactus degrade; sync_node repeats it then
constexpr sync::Nanoseconds kTagRequestPeriod{1'000'000'000};      // as required for TAG_REQUEST

header_t unstamped_header() {
  header_t h{};
  h.sim_time_ns = -1;
  h.run_id = h.incarnation = 1;  // the bus overwrites them; a header without them is not valid
  return h;
}

}  // namespace

Controls::Controls(sync::Bus& bus, ReplyHandler on_reply)
    : bus_(bus),
      on_reply_(std::move(on_reply)),
      replies_(bus.queue<sim_reply_t>(channels::kSimReply, 64)),
      setting_replies_(bus.queue<setting_reply_t>(channels::kSettingReply, 64)),
      frames_(bus.queue<contact_frame_t>(channels::kContacts, 1024)),
      tools_(bus.queue<tool_state_t>(channels::kToolState, 256)),
      degradations_(bus.queue<degradation_t>(channels::kDegradation, 256)),
      scene_(bus),
      simulation_(bus.clocks()) {}

void Controls::command(const Command& command, sync::HostTime now) {
  sim_command_t c{};
  c.header = unstamped_header();
  c.id = sync::request_id();
  c.kind = command.kind;
  c.steps = command.steps;
  command_ = {c, now + kReplyTimeout, now};
}

void Controls::degrade(const DegradeRequest& sliders, std::int64_t realtime_ns, sync::HostTime now) {
  sync::ProfileInForce p;
  p.text = with_sliders(in_force_ && !sliders.clear ? in_force_->text : "", sliders.senses);
  p.hash = sync::fnv1a_64(p.text.data(), p.text.size());
  p.generation = next_generation(in_force_ ? in_force_->generation : -1, realtime_ns);
  if (const auto map = simulation_.map(now)) p.start = std::max(sync::SimTime{}, map->to_sim(now));
  profile_ = in_force_ = p;
  profile_until_ = now + kProfileRepeatTime;
  profile_next_ = now;
}

void Controls::hand(const HandTarget& at, double aspect, sync::HostTime now) {
  if (scene() == nullptr)
    throw std::invalid_argument("the scene is not known yet; try again in a moment");
  if (scene()->tools.empty()) throw std::invalid_argument("this scene has no tool; run a scene with a tool");
  std::optional<Eigen::Vector3d> where;
  if (tool_) where = to_eigen(tool_->device.position_m);
  hand_.aim(at, *scene(), aspect, where, now);
}

void Controls::stream(double rate_Hz, sync::HostTime now) {
  setting_change_t c{};
  c.header = unstamped_header();
  c.id = sync::request_id();
  c.node = "visual_node";
  c.name = "stream";
  std::ostringstream value;
  value << rate_Hz;
  c.value = value.str();
  setting_ = {c, now + kReplyTimeout, now};
}

void Controls::request_tags(const std::vector<std::string>& names, sync::HostTime now) {
  constexpr std::size_t kMaxPatterns = 16, kMaxLength = 128;  // of TAG_REQUEST
  std::vector<std::string> patterns;
  for (const std::string& name : names)
    if (name.size() <= kMaxLength && patterns.size() <= kMaxPatterns) patterns.push_back(name);
  if (patterns.size() > kMaxPatterns) patterns = {"*"};
  if (tags_next_ && patterns == tags_.patterns) return;
  tags_.patterns = patterns;
  tags_.pattern_count = static_cast<std::int16_t>(patterns.size());
  tags_next_ = now;
}

Controls::World Controls::world(sync::HostTime now) const {
  const auto map = simulation_.map(now);
  if (!map || !clock_) return {};
  return {sync::to_seconds(map->to_sim(now).time_since_epoch()), clock_->rate, true};
}

void Controls::step(sync::HostTime now) {
  const auto is_own_run = [&](const header_t& h) { return h.run_id == bus_.identity().run_id; };
  while (const auto m = frames_.pop()) {
    if (!is_own_run(m->message.header)) continue;
    simulation_.track(m->message.header, m->message.clock, m->arrival);
    clock_ = m->message.clock;
  }
  while (auto m = tools_.pop())
    if (is_own_run(m->message.header) && m->message.tool == 0) tool_ = std::move(m->message);
  while (const auto m = degradations_.pop())
    if (is_own_run(m->message.header))
      if (auto received = profiles_.push(m->message);
          received && (!in_force_ || received->generation >= in_force_->generation))
        in_force_ = std::move(received);
  scene_.poll(now);
  while (const auto m = replies_.pop()) {
    if (!command_ || !is_own_run(m->message.header) || m->message.id != command_->message.id) continue;
    command_.reset();
    on_reply_(sync::printable(m->message.text), m->message.done != 0);
  }
  while (const auto m = setting_replies_.pop())
    if (setting_ && is_own_run(m->message.header) && m->message.id == setting_->message.id) setting_.reset();
  if (command_ && now >= command_->until) {
    command_.reset();
    on_reply_("no reply from sim_node; check that it runs", false);
  }
  if (setting_ && now >= setting_->until) setting_.reset();
  if (command_ && now >= command_->next) {
    bus_.publish(channels::kSimCommand, command_->message);
    command_->next = now + kRepeat;
  }
  if (setting_ && now >= setting_->next) {
    bus_.publish(channels::kSetting, setting_->message);
    setting_->next = now + kRepeat;
  }
  if (profile_ && now < profile_until_ && now >= profile_next_) {
    sync::send_profile(bus_, *profile_);
    profile_next_ = now + kRepeat;
  }
  if (tags_next_ && now >= *tags_next_) {
    tags_.header = unstamped_header();
    bus_.publish(channels::kTagRequest, tags_);
    tags_next_ = now + kTagRequestPeriod;
  }
  if (auto state = hand_.state(now)) bus_.publish(channels::kDeviceState, *state);
}

}  // namespace tactus::live
