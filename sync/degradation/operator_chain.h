// The operators of a profile for one modality, applied to its input: once per event and once per snapshot, never per
// repetition or page. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sync/degradation/profile.h"

namespace tactus::sync {

// The properties of an event or a snapshot that the operators decide by.
struct StreamItem {
  std::uint64_t key = 0;  // id of an event, or channel and instant of a snapshot; random numbers are drawn for it
  bool is_event = false;
  // Only for a snapshot: its stream, identified by channel and by group, tool or the like; and the incarnation of the
  // simulation.
  std::uint64_t stream = 0;
  std::int64_t incarnation = 0;
  SimTime time{};
  HostTime arrival{};
  // Only for a snapshot. When its sender published it, ns by the clock of the sender; and its time on a clock that runs
  // while the world stands still, too (stream_pace.h), at least `time`.
  std::int64_t publish_ns = 0;
  SimTime paced{};
  bool has_forces = true;           // a deadband on force passes all snapshots of a stream without forces
  std::span<const Signal> signals;  // of a snapshot, for a deadband
  double speed_m_s = 0;             // of the fastest body or tool in it
  // Only for an event: bodies and materials, by their index in the scene.
  std::int32_t body_a = -1, body_b = -1, material_a = -1, material_b = -1;
};

// kOvertaken: a newer snapshot was released before it, under a jitter that keeps the order; decided at its release.
enum class DropReason : std::int8_t { kKept = 0, kRate, kDeadband, kLoss, kOff, kFreeze, kOvertaken };

struct Decision {
  DropReason why = DropReason::kKept;              // kKept: it is released
  Conceal conceal = Conceal::kHold;  // replacement of a missing snapshot
  HostTime release{};                // time of release
  // Change of the instant of its presentation, beside the presentation delay of the whole modality: for an event the
  // presentation delay of a filtered rule that applies to it; and the jitter of a presentation delay, which may be negative.
  Nanoseconds shift{0};
  Nanoseconds jittered_delay{0};  // the presentation delay that `shift` varies, part of that of the whole modality
  SimTime paced{};                // of the item, for a low-pass
  bool duplicated = false;
  bool in_order = false;   // delayed by a jitter that keeps the order
  bool reordered = false;  // held back by a reorder
  // The first update of the last deadband, also when it is lost later: a receiver that predicts forgets the updates before it.
  bool begins_prediction = false;
  bool evaluated = false;  // an operator was evaluated, so the decision is logged
  bool dropped() const { return why != DropReason::kKept; }
  // True for a snapshot that must not be released after a newer one.
  bool newest_wins() const { return in_order && !reordered; }
};

// The names of the scene's bodies and materials, by index.
struct SceneNames {
  std::vector<std::string> bodies, materials;
};

// A force as the signal of a stage.
struct ForceSample {
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero(), torque_N_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d transient_N = Eigen::Vector3d::Zero();  // part of force_N that is due to hits
  double share = 1;  // factor that its sender has already applied, above 0; not changed by operators
  double energy_J = 0;  // energy that its sender has released so far, a sum; not changed by operators
  double speed_m_s = 0;  // of the hand, for a deadband that widens with it; not changed by operators
  friend bool operator==(const ForceSample&, const ForceSample&) = default;
};

class OperatorChain {
 public:
  OperatorChain() = default;
  // start: when the profile came into force; its from and until count from that time.
  // stage: place in the loop of the modality; empty: its input.
  OperatorChain(const Profile& profile, const std::string& modality, SimTime start, const std::string& stage = "");

  bool empty() const { return rules_.empty(); }
  void set_scene(SceneNames names) { names_ = std::move(names); }

  Decision decide(const StreamItem& item);
  // The same for a force signal: each rule first changes the sample (quantise, gain, low-pass), and its other operators decide on
  // the changed sample.
  Decision decide(const StreamItem& item, ForceSample& sample);
  // Returns true when this message, one of several that repeat or page the same content, is lost on the wire. message: a key
  // that no other message has.
  bool lost_on_wire(std::uint64_t message, SimTime now);
  // Extra presentation delay of the whole modality, from delay and skew.
  Nanoseconds presentation_delay(SimTime now) const;
  OutputValues output(SimTime now) const;
  // Sum of the constant delays of all unfiltered rules in force, of the network and of the presentation.
  Nanoseconds constant_delay(SimTime now) const;
  // Longest time for which an item is usually held back: constant delays, the spread of a jitter, and the period of a rate.
  Nanoseconds usual_delay(SimTime now) const;
  // The deadband of the last unfiltered rule in force that has one; null: none.
  const DeadbandDef* deadband(SimTime now) const;
  // Control of the energy that a rule in force asks for.
  Passivity passivity(SimTime now) const;
  // True while a rule lets nothing through.
  bool cuts_off(SimTime now) const;

  // A value after quantise, gain, bias and low-pass. id: of the contact, body or plane; component: of its vectors; paced: as
  // in StreamItem, for the low-pass.
  double degraded_value(Quantity quantity, std::int64_t id, int component, double value, SimTime t,
                 std::int32_t material_a, std::int32_t material_b, std::int32_t body_a, std::int32_t body_b, SimTime paced = {});
  // A force with its parts after quantise (of its magnitude), gain and low-pass; the torque only after gain and low-pass.
  void degrade_force(ForceSample& sample, SimTime t);
  bool changes_values() const { return changes_values_; }
  // True when a rule compares the content of a snapshot, so that all of its pages are needed for a decision.
  bool compares() const { return compares_; }
  // Messages of streams with a wire loss so far, and the lost ones among them.
  std::int64_t wire_messages() const { return wire_messages_; }
  std::int64_t wire_lost() const { return wire_lost_; }

 private:
  // The state of the operators of one rule, separate for events and for each stream of snapshots. It is reset when the world
  // restarts.
  struct Chain {
    std::int64_t incarnation = 0;
    SimTime newest{}, newest_before{};  // of all items; of those before the current one
    std::optional<Loss> loss;
    std::optional<Jitter> jitter;
    std::optional<Deadband> deadband;
    // Of the rate: the newest slots of simulated time and of publication time with an item.
    std::int64_t newest_slot = INT64_MIN, newest_publish_slot = INT64_MIN;
  };
  struct Filtered {
    double value;
    SimTime time;
  };
  struct Active {
    Rule rule;
    std::uint64_t seed;
    std::map<std::uint64_t, Chain> chains;  // by stream; 0: events
    std::map<std::pair<std::int64_t, int>, Filtered> lowpass;
  };

  Decision decide(StreamItem item, ForceSample* sample);
  void degrade(Active& a, ForceSample& sample, SimTime t);
  double filtered(Active& a, std::int64_t id, int component, double value, double cutoff_Hz, SimTime now);
  double elapsed_s(SimTime t) const;
  bool active_at(const Rule& rule, SimTime t) const;
  static Chain& chain_of(Active& a, const StreamItem& item);
  bool applies_to(const Rule& rule, std::int32_t material_a, std::int32_t material_b, std::int32_t body_a,
                std::int32_t body_b) const;
  bool drops(Active& a, Chain& chain, const StreamItem& item, Decision& decision);
  bool thinned(const RateDef& rate, Chain& chain, const StreamItem& item) const;
  void delay_item(Active& a, Chain& chain, const StreamItem& item, Decision& decision);

  std::vector<Active> rules_;
  SceneNames names_;
  SimTime start_{};
  bool changes_values_ = false, compares_ = false;
  std::int64_t wire_messages_ = 0, wire_lost_ = 0;
};

}  // namespace tactus::sync
