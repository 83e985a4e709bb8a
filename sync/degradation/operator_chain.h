// The operators of a profile that concern one sense, applied to what arrives for it: once per event and once per
// snapshot, never per repetition or page. Pure.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sync/degradation/profile.h"

namespace tactus::sync {

// What an event or a snapshot is judged by.
struct StreamItem {
  std::uint64_t key = 0;  // an event's id, a snapshot's channel and instant: what its random numbers are drawn for
  bool is_event = false;
  // Of a snapshot: whose sequence it belongs to, its channel and what that tells apart. And the life of the
  // simulation.
  std::uint64_t stream = 0;
  std::int64_t incarnation = 0;
  SimTime time{};
  HostTime arrival{};
  std::span<const Signal> signals;  // of a snapshot, for a deadband
  double speed_m_s = 0;             // of the fastest thing in it
  // Of an event: bodies and materials, as in the scene.
  std::int32_t body_a = -1, body_b = -1, material_a = -1, material_b = -1;
};

enum class DropReason : std::int8_t { kKept = 0, kRate, kDeadband, kLoss, kOff, kFreeze };

struct Decision {
  DropReason why = DropReason::kKept;              // kKept: it is let through
  Conceal conceal = Conceal::kHold;  // what a missing snapshot is replaced by
  HostTime release{};                // when it is let through
  Nanoseconds shift{0};              // of the instant of an event that a filtered presentation delay concerns
  bool twice = false;
  bool touched = false;  // an operator was asked: worth a line in the log
  bool dropped() const { return why != DropReason::kKept; }
};

// What the scene calls its bodies and materials, by index.
struct SceneNames {
  std::vector<std::string> bodies, materials;
};

class OperatorChain {
 public:
  OperatorChain() = default;
  // start: when the profile came into force; its from and until count from there.
  OperatorChain(const Profile& profile, const std::string& modality, SimTime start);

  bool empty() const { return rules_.empty(); }
  void set_scene(SceneNames names) { names_ = std::move(names); }

  Decision decide(const StreamItem& item);
  // True: this message, which is one of several that repeat or page the same thing, is lost on the wire. message:
  // what tells it from all others.
  bool lost_on_wire(std::uint64_t message, SimTime now);
  // How much later the whole sense presents, by delay and skew.
  Nanoseconds presentation_delay(SimTime now) const;
  OutputValues output(SimTime now) const;

  // A value after quantise, gain, bias and low-pass. id: of the contact, body or plane; component: of its vectors.
  double changed(Quantity quantity, std::int64_t id, int component, double value, SimTime t,
                 std::int32_t material_a, std::int32_t material_b, std::int32_t body_a, std::int32_t body_b);
  bool changes_values() const { return changes_values_; }
  // Whether a snapshot is judged by what is in it, so that all of it must be there.
  bool compares() const { return compares_; }

 private:
  // The memory of the operators of one rule, of events and of each stream of snapshots apart: none disturbs
  // another's sequence. It begins anew with the world.
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
    std::map<std::uint64_t, Chain> chains;  // by stream; of events 0
    std::map<std::pair<std::int64_t, int>, Filtered> lowpass;
  };

  double elapsed_s(SimTime t) const;
  bool in_time(const Rule& rule, SimTime t) const;
  static Chain& chain_of(Active& a, const StreamItem& item);
  bool concerns(const Rule& rule, std::int32_t material_a, std::int32_t material_b, std::int32_t body_a,
                std::int32_t body_b) const;
  bool dropped(Active& a, Chain& chain, const StreamItem& item, Decision& v);
  void held(Active& a, Chain& chain, const StreamItem& item, Decision& v);

  std::vector<Active> rules_;
  SceneNames names_;
  SimTime start_{};
  bool changes_values_ = false, compares_ = false;
};

}  // namespace tactus::sync
