// The endpoint of a modality on the bus: input streams, the operators of the degradation profile on them, playout delay, and
// reports of presented events. Each rendering node has one.
//
//   sync::ModalityEndpoint endpoint(node);
//   auto& events = endpoint.events();
//   while (node.running()) {
//     const sync::HostTime now = node.wait();
//     sense.step(now);                        // receives new messages, releases the due ones
//     for (const contact_event_t& e : events.inbox().take(...)) ...
//     ... render the state of the world at now - sense.delay() ...
//     sense.publish(now);
//   }
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/degradation_t.hpp>
#include <tactus/playout_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/scene_t.hpp>
#include <vector>

#include "sync/degradation/degraded_snapshots.h"
#include "sync/degradation/measured_effect.h"
#include "sync/resampling/event_inbox.h"
#include "sync/degradation/profile_exchange.h"
#include "sync/node/node.h"
#include "sync/playout/follower.h"
#include "sync/playout/lockstep.h"
#include "sync/presentation/presentation_reporter.h"
#include "sync/clocks/sim_clock_tracker.h"

namespace tactus::sync {

template <class Message>
struct Delivered {
  Message message;
  HostTime arrival;  // when it arrived from the bus, before any delay of the profile
};

class ModalityEndpoint {
 public:
  // A message stream of this modality. The renderer reads it instead of the inbox.
  template <class Message>
  class Stream {
   public:
    // The next message that is released by now.
    std::optional<Delivered<Message>> pop() {
      auto next = degraded_.pop(now_);
      if (!next) return std::nullopt;
      return Delivered<Message>{std::move(next->first), next->second};
    }
    const InputCount& count() const { return inbox_.count(); }
    // The arrival of its newest message of the followed simulation, before any delay of the profile; the epoch: none. Ages of
    // an input are judged by it, because other channels and other simulations do not replace a lost input.
    HostTime newest_arrival() const { return newest_; }
    // Sets a function that receives every message of the followed simulation as it arrives from the bus, before the
    // operators of the profile.
    void on_arrival(std::function<void(const Message&, HostTime arrival)> listener) { arrival_listener_ = std::move(listener); }

   private:
    friend class ModalityEndpoint;
    explicit Stream(Queue<Message>& inbox) : inbox_(inbox) {}
    Queue<Message>& inbox_;
    DegradedSnapshots<Message> degraded_;
    std::function<void(const Message&, HostTime)> arrival_listener_;
    bool delayed_ = false;
    HostTime now_{}, newest_{};
  };

  // The contact events of this modality.
  class Events {
   public:
    EventInbox& inbox() { return inbox_; }
    const InputCount& count() const { return received_.count(); }
    HostTime newest_arrival() const { return newest_; }  // as of a Stream

   private:
    friend class ModalityEndpoint;
    Events(Queue<contact_events_t>& received, OwnClock own) : received_(received), inbox_(own) {}
    Queue<contact_events_t>& received_;
    EventInbox inbox_;
    HostTime newest_{};
  };

  // Reads the node's --degrade. Throws std::runtime_error with one sentence when the file is not a valid profile.
  explicit ModalityEndpoint(Node& node);
  // Observes the modality of another process: the same streams, with the decisions of the same profile and the playout delay
  // of that process. Publishes nothing. An observer, such as the simulated player, so receives exactly the input of that
  // modality's renderer.
  ModalityEndpoint(Node& node, NodeDescriptor observed);
  ~ModalityEndpoint();

  // Create streams before the first step.
  Events& events(std::size_t capacity = 4096);
  template <class Message>
  Stream<Message>& snapshots(const char* channel, std::size_t capacity) {
    return add<Message>(channel, capacity);
  }
  // For a modality without a movable instant of presentation (a servo loop): its input messages are delayed instead.
  template <class Message>
  Stream<Message>& delayed_snapshots(const char* channel, std::size_t capacity) {
    auto& stream = add<Message>(channel, capacity);
    stream.delayed_ = true;
    stream.degraded_.present_on_release();
    return stream;
  }

  // The operators of a further stage of this modality (sync/degradation/known_modalities.h), from the profile in force. The
  // process in which the stage acts applies them, and adds their decisions. Create it before the first step.
  struct Stage {
    std::string name;
    OperatorChain operators{};
    Decisions decisions{};  // published as of the modality "NAME:STAGE"
    MeasuredEffect effect{};
  };
  Stage& stage(const std::string& name);

  // A scene is complete: its names, its tool and its profile. tool: index in scene_t.tools; -1: none.
  void set_scene(const scene_t& scene, int tool = -1);
  // The same for a process without scene: its profile, XML; empty: none.
  void set_scene_profile(const std::string& profile);
  // The presentation delay of this modality while no PLAYOUT message sets one; and its maximum latency from the arrival of an
  // event to its output.
  void set_own_delay(Nanoseconds delay) { playout_.set_own(delay); }
  void set_output_latency(Nanoseconds latency) { output_latency_ = latency; }

  // Call it once a tick.
  void step(HostTime now);

  // Presentation delay by policy and by profile: the output at now shows the world at now - delay(). In lock-step it grows
  // until the next iteration of the loop.
  Nanoseconds delay() const { return delay_; }
  // Simulated time as of the last step; 0: not known yet.
  SimTime sim_now() const { return sim_now_; }
  // The part of delay() that the profile adds.
  Nanoseconds profile_delay() const { return profile_delay_; }
  // The time at which the output shows the state of the world at `happened`: p with p - delay() at p = happened.
  HostTime presentation_of(HostTime happened) const;
  // The time at which to present an event that happened at `happened`: delay() later, or as soon as this modality can under
  // the policy asap.
  HostTime schedule(std::int64_t event_id, HostTime happened) const;
  // Output operators in force.
  const OutputValues& output() const { return output_; }
  // The name of the profile in force, whether or not it applies to this modality; empty: there is none.
  const std::string& profile_name() const { return profile_name_; }
  // The arrival of the newest message of any stream, before any delay of the profile. Messages of a second simulation do not
  // count.
  HostTime newest_arrival() const;
  // Whether a second simulation sends. Its messages are ignored.
  bool simulation_conflict(HostTime now) const { return simulation_.conflict(now); }

  void report(const presentation_t& report);
  // Sets a function that receives every report. Needed when a log is rendered: nothing reads the reports from the bus then.
  void set_report_listener(std::function<void(const presentation_t&)> listener) { report_listener_ = std::move(listener); }
  // Publishes reports, the decisions of the profile, and its measured effect in the health of the node.
  void publish(HostTime now);

 private:
  struct AnyStream {
    virtual ~AnyStream() = default;
    virtual void step(ModalityEndpoint& endpoint, HostTime now, HostTime state_time) = 0;
    virtual void change_profile() = 0;
    virtual HostTime newest_arrival() const = 0;
  };
  template <class Message>
  struct StreamSlot : AnyStream {
    explicit StreamSlot(Queue<Message>& inbox) : stream(inbox) {}
    void step(ModalityEndpoint& endpoint, HostTime now, HostTime state_time) override;
    void change_profile() override { stream.degraded_.change_profile(); }
    HostTime newest_arrival() const override { return stream.newest_; }
    Stream<Message> stream;
  };
  struct EventSlot : AnyStream {
    explicit EventSlot(Events e) : events(std::move(e)) {}
    void step(ModalityEndpoint& endpoint, HostTime now, HostTime state_time) override;
    void change_profile() override {}  // each event has its own decision
    HostTime newest_arrival() const override { return events.newest_; }
    Events events;
  };
  template <class Message>
  Stream<Message>& add(const char* channel, std::size_t capacity) {
    auto slot = std::make_unique<StreamSlot<Message>>(node_.bus().queue<Message>(channel, capacity));
    auto& stream = slot->stream;
    streams_.push_back(std::move(slot));
    return stream;
  }

  // Follows the simulation. False: the message is of a second one and is not used.
  bool follow(const header_t& header, const sim_clock_t& clock, HostTime arrival) {
    simulation_.track(header, clock, arrival);
    return simulation_.follows(header);
  }
  // Logs the delay of events that have arrived and are not presented yet, when a delay of a profile begins: it applies to
  // them, too.
  void log_in_flight_delays(HostTime now, SimTime sim_now);
  void read_control_messages(HostTime now);
  void apply_profile(const ProfileInForce& profile);
  // Prints the profile in force, and its effect here.
  void announce_profile() const;
  // The first arrival of an event from the bus; nullopt: it has not arrived, or has been forgotten.
  std::optional<HostTime> arrival_of(std::int64_t event_id) const;
  void report_dropped(const std::vector<contact_event_t>& dropped);
  bool expects(const contact_event_t& event) const;
  void publish_decisions(const std::string& name, Decisions& decisions, MeasuredEffect& effect, Nanoseconds delay);
  // Prints the effect of the profile in force.
  void report_effect();

  Node& node_;
  NodeDescriptor descriptor_;
  bool observes_ = false;
  Queue<degradation_t>& degradations_;
  Queue<playout_t>& playouts_;
  ProfileReceiver receiver_;
  std::int64_t profile_hash_ = 0;
  std::string profile_name_;
  OperatorChain operators_;
  SceneNames names_;
  int tool_ = -1;
  std::list<Stage> stages_;
  SimTime profile_start_{};
  std::shared_ptr<const Profile> parsed_;
  bool announce_pending_ = false;
  SimTime sim_now_{};
  Decisions decisions_;
  MeasuredEffect effect_;
  HostTime next_decisions_{};
  std::vector<std::unique_ptr<AnyStream>> streams_;
  SimClockTracker simulation_;
  PlayoutFollower playout_;
  std::optional<Lockstep> lockstep_;
  Nanoseconds delay_{0}, serial_delay_{0}, profile_delay_{0}, output_latency_{0};
  OutputValues output_;
  PresentationReporter reporter_;
  std::function<void(const presentation_t&)> report_listener_;
  Events* events_ = nullptr;  // in streams_; null: the modality receives none
};

template <class Message>
void ModalityEndpoint::StreamSlot<Message>::step(ModalityEndpoint& endpoint, HostTime now, HostTime state_time) {
  // If reading takes long, this tick also accepts the messages that arrive in the meantime.
  HostTime newest_arrival = now;
  while (auto m = stream.inbox_.pop()) {
    newest_arrival = std::max(newest_arrival, m->arrival);
    if constexpr (requires { m->message.clock; })
      if (!endpoint.follow(m->message.header, m->message.clock, m->arrival)) continue;
    if (stream.arrival_listener_) stream.arrival_listener_(m->message, m->arrival);
    stream.newest_ = std::max(stream.newest_, m->arrival);
    stream.degraded_.push(std::move(m->message), m->arrival, endpoint.operators_, &endpoint.decisions_);
  }
  // In lock-step the state of the world is the state at the start of the iteration; each event carries its own due time.
  stream.now_ = (state_time != now ? state_time : newest_arrival) - (stream.delayed_ ? endpoint.profile_delay_ : Nanoseconds(0));
}

}  // namespace tactus::sync
