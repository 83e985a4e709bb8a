// The source of a renderer's ticks: the clock of the machine, or the clock of a log. The loop is the same.
#pragma once

#include "sync/node/node.h"
#include "sync/node/offline.h"

namespace tactus::sync {

class TickSource {
 public:
  // log: rendered instead of the bus; null: live. Both outlive this object.
  TickSource(Node& node, OfflineInput* log) : node_(node), log_(log) {}

  bool live() const { return log_ == nullptr; }
  // The log is over.
  bool over() const { return log_ && log_->over(); }
  // The time of the next tick; its messages are then in the inboxes. Live: sleeps until that time.
  HostTime next() { return log_ ? log_->next(node_.bus()) : node_.wait(); }
  // The time within a tick. In a log a tick takes no time.
  HostTime now() const { return log_ ? log_->now() : host_now(); }

 private:
  Node& node_;
  OfflineInput* log_;
};

}  // namespace tactus::sync
