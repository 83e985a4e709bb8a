// Reception and bookkeeping of the subscriber of the cluster tests.
#include "sync/clocks/pacing.h"
#include "tests/cluster/support/cluster_monitor.h"

#include <cmath>
#include <stdexcept>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/input_health_t.hpp>
#include <tactus/presentation_t.hpp>

namespace tactus::cluster {
namespace {

constexpr std::size_t kQueue = 8192;
constexpr sync::Nanoseconds kHealthTimeout{1'500'000'000};
constexpr sync::Nanoseconds kPollInterval{20'000'000};

}  // namespace

ClusterMonitor::ClusterMonitor(std::int64_t run_id)
    : run_id_(run_id),
      bus_(sync::Identity::fresh("test", run_id), {}),
      health_queue_(bus_.queue<node_health_t>(channels::kNodeHealth, kQueue)),
      tool_queue_(bus_.queue<tool_state_t>(channels::kToolState, kQueue)),
      contact_queue_(bus_.queue<contact_frame_t>(channels::kContacts, kQueue)),
      event_queue_(bus_.queue<contact_events_t>(channels::kContactEvents, kQueue)),
      presented_queue_(bus_.queue<presented_t>(channels::kPresented, kQueue)) {}

bool ClusterMonitor::wait_until(const std::function<bool()>& condition, double timeout_s) {
  const sync::HostTime end = sync::host_now() + sync::from_seconds(timeout_s);
  for (;;) {
    drain();
    if (condition()) return true;
    if (sync::host_now() > end) return false;
    bus_.wait(kPollInterval);
  }
}

void ClusterMonitor::receive_for(double seconds) {
  wait_until([] { return false; }, seconds);
}

void ClusterMonitor::drain() {
  bus_.drain(sync::host_now());
  const auto is_own_run = [&](const header_t& h) { return h.run_id == run_id_; };
  while (auto m = health_queue_.pop()) {
    if (!is_own_run(m->message.header)) continue;
    NodeStatus& status = nodes_[m->message.node];
    if (status.health.header.incarnation != m->message.header.incarnation) ++status.incarnations;
    status.health = std::move(m->message);
    status.arrival = m->arrival;
  }
  while (auto m = tool_queue_.pop())
    if (is_own_run(m->message.header)) tool_ = std::move(m->message);
  while (auto m = contact_queue_.pop())
    if (is_own_run(m->message.header)) on_message(m->message);
  while (auto m = event_queue_.pop())
    for (const contact_event_t& e : m->message.events)
      if (e.kind == contact_event_t::HIT) hits_.insert(e.event_id);
  while (auto m = presented_queue_.pop())
    if (is_own_run(m->message.header))
      for (const presentation_t& p : m->message.reports) presented_[m->message.modality][p.event_id] = p;
}

void ClusterMonitor::on_message(const contact_frame_t& page) {
  Snapshot& part = partial_[page.group];
  if (part.incarnation != page.header.incarnation || part.sim_time_ns != page.header.sim_time_ns)
    part = Snapshot{page.header.incarnation, page.header.sim_time_ns, page.pages, {}};
  auto& ids = part.ids[page.page];
  ids.clear();
  for (const contact_t& c : page.contacts) ids.push_back(c.contact_id);
  if (static_cast<int>(part.ids.size()) == part.pages && page.group < 3) snapshots_[page.group] = part;
}

std::set<std::int64_t> ClusterMonitor::contact_ids() const {
  std::set<std::int64_t> all;
  for (const Snapshot& s : snapshots_)
    for (const auto& [page, ids] : s.ids) all.insert(ids.begin(), ids.end());
  return all;
}

const node_health_t* ClusterMonitor::health(const std::string& node) const {
  const auto it = nodes_.find(node);
  if (it == nodes_.end() || sync::host_now() - it->second.arrival > kHealthTimeout) return nullptr;
  return &it->second.health;
}

const node_health_t& ClusterMonitor::newest_health(const std::string& node) const {
  const auto it = nodes_.find(node);
  if (it == nodes_.end()) throw std::runtime_error(node + " has sent no health");
  return it->second.health;
}

bool ClusterMonitor::in_state(const std::string& node, std::int8_t state) const {
  const node_health_t* h = health(node);
  return h && h->state == state;
}

std::int64_t ClusterMonitor::ticks(const std::string& node) const {
  const auto it = nodes_.find(node);
  return it == nodes_.end() ? 0 : it->second.health.ticks;
}

std::int64_t ClusterMonitor::rendered(const std::string& node) const {
  const auto it = nodes_.find(node);
  return it == nodes_.end() ? 0 : it->second.health.contacts_rendered;
}

std::int64_t ClusterMonitor::malformed(const std::string& node) const {
  std::int64_t sum = 0;
  if (const auto it = nodes_.find(node); it != nodes_.end())
    for (const input_health_t& in : it->second.health.inputs) sum += in.bad;
  return sum;
}

std::int64_t ClusterMonitor::rejoined(const std::string& node) const {
  const auto it = nodes_.find(node);
  return it == nodes_.end() ? 0 : it->second.incarnations - 1;
}

double ClusterMonitor::force_N() const { return tool_ ? std::hypot(tool_->force_N.x, tool_->force_N.y, tool_->force_N.z) : -1; }

}  // namespace tactus::cluster
