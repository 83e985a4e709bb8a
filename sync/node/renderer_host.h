// The services of the host for a renderer: its node, its endpoint on the bus, and its clock, live or from a log.
#pragma once

#include <string>
#include <tactus/presentation_t.hpp>

#include "sync/node/node.h"
#include "sync/node/tick_source.h"
#include "sync/node/modality_endpoint.h"

namespace tactus::sync {

class RendererHost {
 public:
  RendererHost(Node& node, ModalityEndpoint& endpoint, const TickSource& ticks) : node_(node), endpoint_(endpoint), ticks_(ticks) {}

  Node& node() { return node_; }
  Bus& bus() { return node_.bus(); }
  // The input streams of the modality, its delay, and the effect of the profile on both.
  ModalityEndpoint& endpoint() { return endpoint_; }
  const NodeDescriptor& descriptor() const { return node_.descriptor(); }
  const NodeOptions& options() const { return node_.options(); }

  // False: a log is rendered, as fast as possible.
  bool live() const { return ticks_.live(); }
  // The time within a tick. In a log a tick takes no time.
  HostTime clock() const { return ticks_.now(); }

  // Reports the outcome of an event. rendered: it counts as rendered in NODE_HEALTH.
  void report(const presentation_t& report, bool rendered = true) {
    endpoint_.report(report);
    if (rendered) node_.count_rendered(1);
  }
  // Prints a sentence for the user, after the name of the process.
  void print_status(const std::string& sentence) const { print(options().name + ": " + sentence); }
  void print(const std::string& line) const;

 private:
  Node& node_;
  ModalityEndpoint& endpoint_;
  const TickSource& ticks_;
};

}  // namespace tactus::sync
