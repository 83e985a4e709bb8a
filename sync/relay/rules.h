// The channels that cross the line to another site, as data. Read from XML; an invalid file is refused as a whole.
//
//   <relay>
//     <pass channel="CONTACT_EVENTS" first="true"/>
//     <pass channel="WORLD_STATE" deadband="0% position floor=0.5mm"/>
//     <pass channel="TOOL_STATE" rate="60Hz"/>
//   </relay>
//
// Channels without a rule do not cross, in either direction.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sync/degradation/profile.h"

namespace tactus::sync {

// One <pass>. rate and deadband are the operators of a degradation profile (sync/degradation/README.md).
struct PassRule {
  std::string channel;
  bool first = false;  // sent before all others, and dropped last
  Rule thinning;       // its rate and its deadband, if given
  int line = 0;

  bool decimates() const { return thinning.rate || thinning.deadband; }
};

class RelayRules {
 public:
  explicit RelayRules(std::vector<PassRule> rules) : rules_(std::move(rules)) {}
  // Returns null when the channel does not pass the relay.
  const PassRule* find(std::string_view channel) const;
  const std::vector<PassRule>& all() const { return rules_; }

 private:
  std::vector<PassRule> rules_;
};

// Throws std::invalid_argument, "FILE:LINE: reason and remedy". file: the name for messages.
RelayRules parse_relay_rules(const std::string& xml, const std::string& file);

}  // namespace tactus::sync
