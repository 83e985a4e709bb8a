// The static description of a node: its name, its modality, its inputs, its rate, and the degradations of its output that a
// profile can request. Each node folder holds one; sync/ contains no other list of modalities.
#pragma once

#include <string>
#include <tactus/node_health_t.hpp>
#include <vector>

#include "sync/degradation/output_operator.h"
#include "sync/presentation/late.h"
#include "sync/time/phases.h"

namespace tactus::sync {

struct NodeDescriptor {
  std::string name;      // of the process: "audio_node"
  std::string modality;  // "audio"; empty: it renders nothing
  int expected_events = node_health_t::EXPECTS_NOTHING;  // bits of node_health_t: each such event needs a report
  double rate_Hz = 100;
  int fifo_priority = 0;  // 0: normal scheduling
  std::string about;      // one sentence for --help

  // Only for a modality.
  std::vector<std::string> inputs = {};    // channels that it reads and that its profile acts on
  std::string presentation_instant = {};   // the instant that PRESENTED reports
  LateRule late_rule = LateRule::kShowNewest;    // treatment of late events
  std::vector<OutputOperator> output_operators = {};  // operators on its output that a profile can use

  std::vector<Phase> phases = {};  // tagged phases of its tick in addition to decoding and the rest: "work.render"
  // It opens sockets of its own after the Node, and calls drop_receive_buffer_right() (sync/bus/receive_buffer.h) after them;
  // otherwise the Node does.
  bool opens_sockets = false;
};

}  // namespace tactus::sync
