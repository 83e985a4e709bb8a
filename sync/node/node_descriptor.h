// A modality is a declaration: what it reads, how often it ticks, what instant it calls presented, what becomes of
// what is late, and what about its output can be degraded. A node folder declares; sync/ does the rest.
#pragma once

#include <string>
#include <tactus/node_health_t.hpp>
#include <vector>

#include "sync/presentation/late.h"
#include "sync/time/phases.h"

namespace tactus::sync {

struct NodeDescriptor {
  std::string node;      // "audio_node"
  std::string modality;  // "audio"; empty: renders nothing
  int owes = node_health_t::OWES_NOTHING;
  double rate_Hz = 100;
  int fifo_priority = 0;  // 0: normal scheduling
  std::string about;      // one sentence for --help

  // Of a modality only.
  std::vector<std::string> inputs = {};  // channels that it reads: its profile acts on them
  std::string presents = {};             // the instant that PRESENTED speaks of
  Late late = Late::kShowNewest;
  std::vector<std::string> degradable = {};  // attributes of a profile that act on its output, e.g. "frame_rate"

  std::vector<Phase> phases = {};  // of its tick, that are tagged beside decoding and what is left: "work.render", ...
};

}  // namespace tactus::sync
