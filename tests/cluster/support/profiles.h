// Puts degradation profiles in force in a running cluster, and measures the delays of its modalities.
#pragma once

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/cluster/support/running.h"

namespace tactus::cluster {

// Runs the command line program. rules: <degrade .../> elements; "": no degradation. Returns the program's output.
inline std::string put_in_force(RunningCluster& c, const std::string& rules) {
  static int number = 0;
  const std::string name = "degrade" + std::to_string(++number);
  const std::filesystem::path file = c.folder.path() / (name + ".xml");
  std::ofstream(file) << "<profile name=\"" << name << "\">" << rules << "</profile>";
  c.processes.spawn(
      name, {programs() / "degrade", "--run-id", std::to_string(RunningCluster::kRunId), rules.empty() ? "off" : file});
  const int status = c.processes.wait_for_exit(name, kTimeout_s);
  INFO(c.processes.output(name));
  CHECK(status == 0);
  return c.processes.output(name);
}

// Requests a playout policy by the command line program. Returns the program's output.
inline std::string request_playout(RunningCluster& c, std::vector<std::string> words) {
  static int number = 0;
  const std::string name = "playout" + std::to_string(++number);
  std::vector<std::string> command{programs() / "playout", "--run-id", std::to_string(RunningCluster::kRunId)};
  command.insert(command.end(), words.begin(), words.end());
  c.processes.spawn(name, command);
  const int status = c.processes.wait_for_exit(name, kTimeout_s);
  INFO(c.processes.output(name));
  CHECK(status == 0);
  return c.processes.output(name);
}

using PresentedEvents = std::map<std::string, std::set<std::int64_t>>;

// The events that each modality has reported so far.
inline PresentedEvents presented_events(const ClusterMonitor& monitor) {
  PresentedEvents heard;
  for (const auto& [modality, reports] : monitor.presented())
    for (const auto& [id, report] : reports) heard[modality].insert(id);
  return heard;
}

// Delays of the events reported since, from the earliest possible presentation to the presentation, ms.
inline std::vector<double> delays_ms(const ClusterMonitor& monitor, const std::string& modality, const PresentedEvents& before) {
  std::vector<double> out;
  const auto reports = monitor.presented().find(modality);
  if (reports == monitor.presented().end()) return out;
  const auto known = before.find(modality);
  for (const auto& [id, r] : reports->second)
    if (r.presented_ns >= 0 && r.ready_ns >= 0 && (known == before.end() || !known->second.contains(id)))
      out.push_back(static_cast<double>(r.presented_ns - r.ready_ns) * 1e-6);
  return out;
}

inline double median(std::vector<double> x) {
  REQUIRE_FALSE(x.empty());
  std::nth_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2), x.end());
  return x[x.size() / 2];
}

}  // namespace tactus::cluster
