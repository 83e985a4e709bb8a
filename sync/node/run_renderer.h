// The renderer host: the common part of the processes of all modalities. It owns the options, the bus, scene reception, live
// settings, degradation, playout, health, real-time priority and the loop. The input is the bus or a log.
//
// A node's run.cpp is a descriptor, a factory and a call:
//
//   const sync::NodeDescriptor kWind{.name = "wind_node", .modality = "wind", ...};
//   int main(int argc, char** argv) {
//     sync::PlainFactory<WindRenderer> factory;
//     return sync::run_renderer(kWind, factory, argc, argv);
//   }
#pragma once

#include <memory>

#include "sync/node/renderer.h"

namespace tactus::sync {

// Creates the renderer of a node in three steps: options, resources that are opened before the bus, the renderer itself.
class RendererFactory {
 public:
  virtual ~RendererFactory() = default;

  // Adds the options of this node to the common options of all nodes.
  virtual void add_options(Arguments&) {}
  // Called after the options are parsed and before the bus is joined. Checks the options and opens the resources that can
  // fail. Returns the log to render instead of the bus, or null to render the bus. This factory owns the log. Throws
  // std::runtime_error with one sentence.
  virtual OfflineInput* prepare(const NodeOptions& options) = 0;
  // Subscribes to the inputs. host: outlives the renderer.
  virtual std::unique_ptr<Renderer> make(RendererHost& host) = 0;
};

// For a renderer without options of its own that renders no log.
template <class Made>
class PlainFactory : public RendererFactory {
  OfflineInput* prepare(const NodeOptions&) override { return nullptr; }
  std::unique_ptr<Renderer> make(RendererHost& host) override { return std::make_unique<Made>(host); }
};

// Runs the program. Returns its exit status; when it is not 0, one sentence on stderr gives the reason.
int run_renderer(const NodeDescriptor& descriptor, RendererFactory& factory, int argc, char** argv);

}  // namespace tactus::sync
