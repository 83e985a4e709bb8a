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
  std::span<const Signal> signals;  // of a snapshot, for a deadband
  double speed_m_s = 0;             // of the fastest body or tool in it
  // Only for an event: bodies and materials, by their index in the scene.
  std::int32_t body_a = -1, body_b = -1, material_a = -1, material_b = -1;
};

enum class DropReason : std::int8_t { kKept = 0, kRate, kDeadband, kLoss, kOff, kFreeze };

struct Decision {
  DropReason why = DropReason::kKept;              // kKept: it is released
  Conceal conceal = Conceal::kHold;  // replacement of a missing snapshot
  HostTime release{};                // time of release
  Nanoseconds shift{0};              // only for an event: the presentation delay of a filtered rule that applies to it
  bool duplicated = false;
  bool evaluated = false;  // an operator was evaluated, so the decision is logged
  bool dropped() const { return why != DropReason::kKept; }
};

// The names of the scene's bodies and materials, by index.
struct SceneNames {
  std::vector<std::string> bodies, materials;
};

class OperatorChain {
 public:
  OperatorChain() = default;
  // start: when the profile came into force; its from and until count from that time.
  OperatorChain(const Profile& profile, const std::string& modality, SimTime start);

  bool empty() const { return rules_.empty(); }
  void set_scene(SceneNames names) { names_ = std::move(names); }

  Decision decide(const StreamItem& item);
  // Returns true when this message, one of several that repeat or page the same content, is lost on the wire. message: a key
  // that no other message has.
  bool lost_on_wire(std::uint64_t message, SimTime now);
  // Extra presentation delay of the whole modality, from delay and skew.
  Nanoseconds presentation_delay(SimTime now) const;
  OutputValues output(SimTime now) const;

  // A value after quantise, gain, bias and low-pass. id: of the contact, body or plane; component: of its vectors.
  double degraded_value(Quantity quantity, std::int64_t id, int component, double value, SimTime t,
                 std::int32_t material_a, std::int32_t material_b, std::int32_t body_a, std::int32_t body_b);
  bool changes_values() const { return changes_values_; }
  // True when a rule compares the content of a snapshot, so that all of its pages are needed for a decision.
  bool compares() const { return compares_; }

 private:
  // The state of the operators of one rule, separate for events and for each stream of snapshots. It is reset when the world
  // restarts.
  struct Chain {
    std::int64_t incarnation = 0;
    SimTime newest{};
    std::optional<Loss> loss;
    std::optional<Jitter> jitter;
    std::optional<Deadband> deadband;
    std::int64_t newest_slot = INT64_MIN;  // of the rate
    HostTime last_release{};
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

  double elapsed_s(SimTime t) const;
  bool active_at(const Rule& rule, SimTime t) const;
  static Chain& chain_of(Active& a, const StreamItem& item);
  bool applies_to(const Rule& rule, std::int32_t material_a, std::int32_t material_b, std::int32_t body_a,
                std::int32_t body_b) const;
  bool drops(Active& a, Chain& chain, const StreamItem& item, Decision& decision);
  void delay_item(Active& a, Chain& chain, const StreamItem& item, Decision& decision);

  std::vector<Active> rules_;
  SceneNames names_;
  SimTime start_{};
  bool changes_values_ = false, compares_ = false;
};

}  // namespace tactus::sync
