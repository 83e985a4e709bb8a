// The measured effect of a profile on one modality: delay, loss, bursts and rate of its events and of its state. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "sync/degradation/decision_record.h"
#include "sync/time/time.h"

namespace tactus::sync {

// Figures of all items that an operator was evaluated for: events, or snapshots of all streams.
struct EffectFigures {
  std::int64_t items = 0, delivered = 0;
  std::int64_t lost = 0, bursts = 0;           // by loss; runs of losses within a stream
  std::int64_t thinned = 0;                    // by rate and deadband
  std::int64_t suppressed = 0;                 // by deadband alone
  std::int64_t off = 0;                        // by off and freeze
  std::int64_t overtaken = 0, repeated = 0;    // by jitter; by duplicate
  double mean_delay_s = 0, sd_delay_s = 0;     // of the delivered items, as the profile adds it
  std::int64_t sent() const { return items - thinned - off; }  // packets of a codec with a deadband
  double rate_Hz = 0;                          // of the delivered items of the fastest stream; 0: not known yet
  double mean_burst() const { return bursts > 0 ? static_cast<double>(lost) / static_cast<double>(bursts) : 0; }
};

// The effect in the text of a health report (node_health_t.status_text), after kEffectPrefix.
inline constexpr std::string_view kEffectPrefix = "; profile effect: ";
// The text before it, and the effect itself; empty: the text contains none.
std::string without_effect(const std::string& status_text);
std::string effect_in(const std::string& status_text);

// Counts the decisions since the profile came into force. A message of the wire that is lost is no decision.
class MeasuredEffect {
 public:
  // Records of one stream in the order of their arrival. presentation_delay: of the profile, for
  // every item.
  void add(const DecisionRecord& record, Nanoseconds presentation_delay);
  // Messages of streams with a wire loss so far, and the lost ones among them.
  void set_wire(std::int64_t messages, std::int64_t lost) { wire_messages_ = messages, wire_lost_ = lost; }

  EffectFigures events() const { return figures(true); }
  EffectFigures snapshots() const { return figures(false); }
  // One line of at most kMaxText printable characters: "events +40.0 ms (sd 3.0), 5.1 % lost in bursts of 3.0; state +40.0 ms
  // (sd 2.9), 59.0/s". With a deadband also "42 of 1000 sent". Empty: nothing was decided.
  std::string text() const;
  static constexpr std::size_t kMaxText = 160;

 private:
  // Streams of one modality are few: groups and tools. More come only from corrupt messages and are not counted.
  static constexpr std::size_t kMaxStreams = 64;
  struct Stream {
    EffectFigures counts;  // without means and rate
    double sum_s = 0, sum_square_s2 = 0, reference_s = 0;  // of the delays minus the first one
    HostTime first{}, last{};
    bool in_burst = false;
  };
  EffectFigures figures(bool events) const;

  std::map<std::uint64_t, Stream> streams_;  // by stream; 0: events
  std::int64_t wire_messages_ = 0, wire_lost_ = 0;
};

}  // namespace tactus::sync
