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
inline std::string put_in_force(Running& c, const std::string& rules) {
  static int number = 0;
  const std::string name = "degrade" + std::to_string(++number);
  const std::filesystem::path file = c.folder.path() / (name + ".xml");
  std::ofstream(file) << "<profile name=\"" << name << "\">" << rules << "</profile>";
  c.processes.spawn(
      name, {programs() / "degrade", "--run-id", std::to_string(Running::kRunId), rules.empty() ? "off" : file});
  const int status = c.processes.wait_for_exit(name, kPatience_s);
  INFO(c.processes.said(name));
  CHECK(status == 0);
  return c.processes.said(name);
}

// Requests a playout policy by the command line program. Returns the program's output.
inline std::string ask_for(Running& c, std::vector<std::string> words) {
  static int number = 0;
  const std::string name = "playout" + std::to_string(++number);
  std::vector<std::string> command{programs() / "playout", "--run-id", std::to_string(Running::kRunId)};
  command.insert(command.end(), words.begin(), words.end());
  c.processes.spawn(name, command);
  const int status = c.processes.wait_for_exit(name, kPatience_s);
  INFO(c.processes.said(name));
  CHECK(status == 0);
  return c.processes.said(name);
}

using EventsHeard = std::map<std::string, std::set<std::int64_t>>;

// The events that each modality has reported so far.
inline EventsHeard heard_of(const Ear& ear) {
  EventsHeard heard;
  for (const auto& [modality, reports] : ear.presented())
    for (const auto& [id, report] : reports) heard[modality].insert(id);
  return heard;
}

// Delays of the events reported since, from the earliest possible presentation to the presentation, ms.
inline std::vector<double> waits_ms(const Ear& ear, const std::string& modality, const EventsHeard& before) {
  std::vector<double> out;
  const auto reports = ear.presented().find(modality);
  if (reports == ear.presented().end()) return out;
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
