// trial_runner: the trial runner of a study. It puts the profiles of the trials in force, asks the participant, moves a hand
// if the study has one, and reports presentations and their times. Commands come on standard input, observations go to
// standard output, one line of JSON each.
//
//   in   NODE_HEALTH, DEGRADATION      the profile of each modality
//        CONTACTS                      the time of the world
//        CONTACT_EVENTS, PRESENTED     events, and their presentation by each modality
//        MEDIA_CLOCK, PICTURE_CHUNK    the time of each sound sample; the pictures, on request
//        GAME_STATE, SIM_REPLY         the state of the game; the result of a command
//        TOOL_STATE                    buttons of the device, which answer; the tick in which a hit vibrates
//        DEVICE_FORCE                  the force on its hand
//        ANSWER                        of a window or a page
//   out  DEGRADATION, QUESTION, ANSWER (of buttons and of simulated participants), SIM_COMMAND
//        DEVICE_STATE                  the pose of its hand, with --hand
//
// When an input is lost, it continues. When its standard input is closed, it ends.
#include "scripts/trial_runner/run.h"

#include <unistd.h>

#include <tactus/degradation_t.hpp>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/answer_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/game_state_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/media_clock_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/picture_chunk_t.hpp>
#include <tactus/presented_t.hpp>
#include <tactus/question_t.hpp>

#include "lcmtypes/generation.h"
#include "scripts/trial_runner/enforcement.h"
#include "scripts/trial_runner/hand.h"
#include "scripts/trial_runner/interview.h"
#include "scripts/trial_runner/lines.h"
#include "scripts/trial_runner/observations.h"
#include "scripts/trial_runner/requests.h"
#include "sync/clocks/pacing.h"
#include "sync/random/keyed_random.h"
#include "sync/bus/identity.h"
#include "sync/node/node.h"
#include "sync/clocks/sim_clock_tracker.h"

using namespace tactus;
using nlohmann::json;

namespace tactus::trial_runner {
namespace {

const sync::NodeDescriptor kTrialRunner{.name = "conductor",
                                        .modality = "",
                                        .rate_Hz = 1000,
                                        .fifo_priority = 55,
                                        .about = "Runs the trials of a study."};
constexpr sync::Nanoseconds kHealthPeriod{500'000'000}, kRepeat{50'000'000};
constexpr int kForceDecimation = 5;  // ticks between two lines on the force of a press
constexpr int kMaxRequestsPerTick = 16;

class TrialRunner {
 public:
  TrialRunner(sync::Node& node, const std::optional<std::pair<Eigen::Vector3d, double>>& hand, bool with_pictures,
            Lines& lines)
      : node_(node),
        lines_(lines),
        observations_(node.bus().clocks()),
        interview_(static_cast<std::uint64_t>(node.bus().identity().incarnation)),
        simulation_(node.bus().clocks()),
        healths_(node.bus().queue<node_health_t>(channels::kNodeHealth, 1024)),
        frames_(node.bus().queue<contact_frame_t>(channels::kContacts, 4096)),
        events_(node.bus().queue<contact_events_t>(channels::kContactEvents, 4096)),
        presented_(node.bus().queue<presented_t>(channels::kPresented, 4096)),
        media_(node.bus().queue<media_clock_t>(channels::kMediaClock, 1024)),
        games_(node.bus().queue<game_state_t>(channels::kGameState, 64)),
        replies_(node.bus().queue<sim_reply_t>(channels::kSimReply, 64)),
        answers_(node.bus().queue<answer_t>(channels::kAnswer, 64)),
        tools_(node.bus().queue<tool_state_t>(channels::kToolState, 256)),
        forces_(node.bus().queue<device_force_t>(channels::kDeviceForce, 64)),
        degradations_(node.bus().queue<degradation_t>(channels::kDegradation, 256)) {
    if (hand) hand_.emplace(hand->first, hand->second);
    if (with_pictures) pictures_ = &node.bus().queue<picture_chunk_t>(channels::kPictureChunk, 4096, sync::Port::kBulk);
    state_.device = kTrialRunner.name;
    state_.pose.orientation.w = 1;
    state_.header.sim_time_ns = -1;
  }

  // One tick. Returns false at the end command, or when the standard input is closed.
  bool step(sync::HostTime now) {
    if (!handle_requests(now)) return false;
    poll_queues(now);
    if (const auto* profile = enforcement_.to_send(now)) sync::send_profile(node_.bus(), *profile);
    if (const auto senses = enforcement_.take_in_force(now))
      write({{"in_force", enforcement_.profile()->hash},
             {"at_ns", sync::to_ns(now)},
             {"since_sim_ns", sync::to_ns(enforcement_.profile()->start)},
             {"senses", *senses}});
    for (question_t page : interview_.step(now)) node_.bus().publish(channels::kQuestion, page);
    if (const question_t& asked = interview_.question(); interview_.is_open() && asked.id != published_question_)
      write({{"asked", std::to_string(asked.id)}, {"at_ns", sync::to_ns(now)}}), published_question_ = asked.id;
    if (command_ && now >= next_command_)
      node_.bus().publish(channels::kSimCommand, *command_), next_command_ = now + kRepeat;
    if (now >= next_health_) write_modalities(now), next_health_ = now + kHealthPeriod;
    step_hand(now);
    lines_.flush();
    return true;
  }

 private:
  // Invalid UTF-8, as in quoted or truncated text, is replaced instead of ending the process.
  void write(const json& line) { lines_.write_line(line.dump(-1, ' ', false, json::error_handler_t::replace)); }

  bool handle_requests(sync::HostTime now) {
    for (int i = 0; i < kMaxRequestsPerTick; ++i) {
      const auto line = lines_.next();
      if (!line) return !lines_.ended();
      try {
        const Request request = parse_request(*line);
        if (std::holds_alternative<EndRequest>(request)) return false;
        std::visit([&](const auto& o) { handle(o, now); }, request);
      } catch (const std::invalid_argument& e) {
        write({{"refused", e.what()}});
      }
    }
    return true;
  }

  void handle(const ProfileRequest& o, sync::HostTime now) {
    if (o.text.size() > sync::kMaxProfileBytes) throw std::invalid_argument("the profile is longer than 64 KiB");
    sync::ProfileInForce profile = sync::read_profile(o.text, "profile");
    profile.generation = next_generation(newest_generation_, sync::realtime_ns());
    if (const auto map = simulation_.map(now)) profile.start = std::max(sync::SimTime{}, map->to_sim(now));
    enforcement_.begin(std::move(profile));
  }
  void handle(const QuestionRequest& o, sync::HostTime) { interview_.ask(o.question); }
  void handle(const AnswerRequest& o, sync::HostTime now) {
    if (auto a = interview_.answer(o.choice, o.number, "simulated", now))
      publish_answer(*a);
    else
      throw std::invalid_argument("no open question fits this answer");
  }
  void handle(const TapRequest& o, sync::HostTime) {
    if (!hand_) throw std::invalid_argument("there is no hand to tap with; start trial_runner with --hand");
    if (!hand_->tap(o)) throw std::invalid_argument("the hand is still moving");
  }
  void handle(const PressRequest& o, sync::HostTime) {
    if (!hand_) throw std::invalid_argument("there is no hand to press with; start trial_runner with --hand");
    if (!hand_->press(o)) throw std::invalid_argument("the hand is still moving");
  }
  void handle(const CommandRequest& o, sync::HostTime now) {
    if (command_) throw std::invalid_argument("the previous command has no reply yet");
    command_.emplace();
    command_->header.sim_time_ns = -1;
    command_->id =
        static_cast<std::int64_t>(
            sync::mixed(static_cast<std::uint64_t>(node_.bus().identity().incarnation), ++commands_) >> 2) +
        1;
    command_->kind = o.kind, command_->name = o.name;
    next_command_ = now;
  }
  void handle(const EndRequest&, sync::HostTime) {}

  // Publishes an answer that was given here, as a window publishes its own.
  void publish_answer(answer_t answer) {
    node_.bus().publish(channels::kAnswer, answer);
    accept_answer(answer);
  }
  void accept_answer(const answer_t& answer) {
    if (const auto a = interview_.accept(answer))
      write({{"answer", std::to_string(a->id)},
             {"choice", a->choice},
             {"number", a->number},
             {"after_s", static_cast<double>(a->after_ns) * 1e-9},
             {"by", a->by}});
  }

  bool is_own_run(const header_t& header) const { return header.run_id == node_.options().run_id; }

  void poll_queues(sync::HostTime now) {
    while (const auto m = healths_.pop())
      if (is_own_run(m->message.header)) enforcement_.push(m->message, m->arrival), store_health(m->message, m->arrival);
    while (const auto m = frames_.pop())
      if (is_own_run(m->message.header)) simulation_.track(m->message.header, m->message.clock, m->arrival);
    while (const auto m = events_.pop())
      if (is_own_run(m->message.header))
        for (const json& line : observations_.push(m->message)) write(line);
    while (const auto m = presented_.pop())
      if (is_own_run(m->message.header))
        for (const json& line : observations_.push(m->message, m->arrival)) write(line);
    while (const auto m = media_.pop())
      if (is_own_run(m->message.header) && m->message.medium.starts_with("audio"))
        if (const auto line = observations_.push(m->message, m->arrival)) write(*line);
    while (const auto m = games_.pop())
      if (is_own_run(m->message.header))
        if (const auto line = observations_.push(m->message)) write(*line);
    while (const auto m = replies_.pop())
      if (command_ && is_own_run(m->message.header) && m->message.id == command_->id) {
        write({{"reply", {{"done", m->message.done == 1}, {"text", m->message.text}}}});
        command_.reset();
      }
    while (const auto m = answers_.pop())
      if (is_own_run(m->message.header)) accept_answer(m->message);
    while (const auto m = tools_.pop())
      if (is_own_run(m->message.header)) {
        handle_buttons(m->message, now);
        if (const auto line = observations_.push(m->message, m->arrival)) write(*line);
      }
    while (const auto m = degradations_.pop())
      if (is_own_run(m->message.header)) newest_generation_ = std::max(newest_generation_, m->message.generation);
    while (const auto m = forces_.pop())
      if (is_own_run(m->message.header) && m->message.device == state_.device) force_N_ = m->message.force_N.z;
    while (pictures_) {
      const auto m = pictures_->pop();
      if (!m) break;
      if (!is_own_run(m->message.header)) continue;
      if (const auto line = observations_.push(m->message, m->arrival)) write(*line);
    }
  }

  // Button 1 is the first choice; any button continues after a text.
  void handle_buttons(const tool_state_t& m, sync::HostTime now) {
    int& before = buttons_[m.header.source];
    const int pressed = m.buttons & ~std::exchange(before, m.buttons);
    for (int i = 0; i < 9; ++i)
      if (pressed >> i & 1 && interview_.question().kind != question_t::NUMBER)
        if (auto a = interview_.answer(i, 0, "button", now)) publish_answer(*a);
  }

  void store_health(const node_health_t& m, sync::HostTime arrival) {
    if (m.modality.empty() || (modalities_.size() >= Enforcement::kMaxModalities && !modalities_.contains(m.node))) return;
    modalities_[m.node] = {m.modality, m.state, m.rate_Hz, m.nominal_rate_Hz, m.missed_ticks, m.profile, arrival};
  }
  void write_modalities(sync::HostTime now) {
    json all = json::object();
    for (const auto& [name, s] : modalities_)
      all[name] = {{"modality", s.modality},
                   {"state", s.state},
                   {"rate_Hz", s.rate_Hz},
                   {"nominal_rate_Hz", s.nominal_rate_Hz},
                   {"missed_ticks", s.missed_ticks},
                   {"age_s", sync::to_seconds(now - s.received)},
                   {"in_force", enforcement_.profile() && s.profile == enforcement_.profile()->hash}};
    json line{{"senses", all}, {"at_ns", sync::to_ns(now)}};
    if (const auto map = simulation_.map(now)) line["sim_ns"] = sync::to_ns(map->to_sim(now));
    write(line);
  }

  void step_hand(sync::HostTime now) {
    if (!hand_) return;
    const bool moved = hand_->busy();
    // After a late tick the hand moves no further than after one in time.
    hand_->step(std::clamp(sync::to_seconds(now - std::exchange(last_tick_, now)), 1e-4, 2e-3));
    const auto& at = hand_->position_m();
    const auto& v = hand_->velocity_m_s();
    if (hand_->presses() && ++ticks_ % kForceDecimation == 0)
      write({{"felt", {{"at_ns", sync::to_ns(now)}, {"z_m", at.z()}, {"force_N", force_N_}}}});
    if (moved && !hand_->busy()) write({{"moved", true}, {"at_ns", sync::to_ns(now)}});
    state_.pose.position_m = {at.x(), at.y(), at.z()};
    state_.velocity_m_s = {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
    state_.state = device_state_t::ANSWERS;
    node_.bus().publish(channels::kDeviceState, state_);
  }

  struct NodeStatus {
    std::string modality;
    int state = 0;
    double rate_Hz = 0, nominal_rate_Hz = 0;
    std::int64_t missed_ticks = 0, profile = 0;
    sync::HostTime received{};
  };

  sync::Node& node_;
  Lines& lines_;
  Observations observations_;
  Enforcement enforcement_;
  Interview interview_;
  std::optional<Hand> hand_;
  sync::SimClockTracker simulation_;
  sync::Queue<node_health_t>& healths_;
  sync::Queue<contact_frame_t>& frames_;
  sync::Queue<contact_events_t>& events_;
  sync::Queue<presented_t>& presented_;
  sync::Queue<media_clock_t>& media_;
  sync::Queue<game_state_t>& games_;
  sync::Queue<sim_reply_t>& replies_;
  sync::Queue<answer_t>& answers_;
  sync::Queue<tool_state_t>& tools_;
  sync::Queue<device_force_t>& forces_;
  sync::Queue<degradation_t>& degradations_;
  std::int64_t newest_generation_ = -1;  // of all profiles
  sync::Queue<picture_chunk_t>* pictures_ = nullptr;
  std::map<std::string, NodeStatus> modalities_;
  std::map<std::int32_t, int> buttons_;  // by source
  std::optional<sim_command_t> command_;
  sync::HostTime next_command_{}, next_health_{}, last_tick_{};
  std::uint64_t commands_ = 0;
  std::int64_t published_question_ = 0;
  int ticks_ = 0;
  float force_N_ = 0;
  device_state_t state_{};
};

}  // namespace

int run(int argc, char** argv) try {
  sync::Arguments app;
  sync::NodeOptions options;
  std::vector<double> rest_m;
  double above_m = 0;
  bool with_pictures = false;
  options.add_to(app, kTrialRunner);
  app.add_option("--hand", rest_m, "rest position of the hand, device external:conductor: X Y Z, m").expected(3);
  app.add_option("--above", above_m, "height of the rest position above the surface, m").range(0.0, 1.0).needs("--hand");
  app.add_flag("--look", with_pictures, "writes the pictures that visual_node streams");
  sync::parse_or_exit(app, kTrialRunner.name, argc, argv);
  std::optional<std::pair<Eigen::Vector3d, double>> hand_pose;
  if (!rest_m.empty()) hand_pose.emplace(Eigen::Vector3d(rest_m[0], rest_m[1], rest_m[2]), above_m);

  Lines lines(STDIN_FILENO, STDOUT_FILENO);
  sync::Node node(kTrialRunner, options);
  TrialRunner runner(node, hand_pose, with_pictures, lines);
  node.set_state(node_health_t::RUNNING);
  while (node.running())
    if (!runner.step(node.wait())) break;
  return 0;
} catch (const std::exception& e) {
  return sync::fail(kTrialRunner.name, e);
}

}  // namespace tactus::trial_runner
