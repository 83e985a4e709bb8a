// A degradation profile in a running cluster.
#include <algorithm>
#include <fstream>

#include "tests/cluster/running.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

int outcomes(const Ear& ear, const std::string& modality, std::int8_t outcome) {
  const auto reports = ear.presented().find(modality);
  if (reports == ear.presented().end()) return 0;
  return static_cast<int>(std::count_if(reports->second.begin(), reports->second.end(),
                                        [&](const auto& r) { return r.second.outcome == outcome; }));
}

// Puts the profile in force through the program that people use. Returns what it said.
std::string degrade(Running& c, const std::string& profile) {
  c.processes.spawn("degrade", {programs() / "degrade", "--run-id", std::to_string(Running::kRunId), profile});
  const int status = c.processes.wait_for_exit("degrade", kPatience_s);
  const std::string said = c.processes.said("degrade");
  INFO(said);
  CHECK(status == 0);
  return said;
}

}  // namespace

TEST_CASE("A profile put in force while the cluster runs degrades its own sense alone, and can be taken away") {
  Running c;
  c.start();
  const std::string file = c.folder.path() / "silence.xml";
  std::ofstream(file) << "<profile name=\"silence\"><degrade modality=\"audio\" off=\"true\"/></profile>";
  const auto before = c.rates(1);
  CHECK(degrade(c, file).find("audio_node") != std::string::npos);

  CHECK(c.ear.wait_until([&] { return outcomes(c.ear, "audio", presentation_t::DROPPED_BY_PROFILE) >= 3; },
                         kPatience_s));
  for (const std::string& other : std::vector<std::string>{"haptic", "visual"})
    CHECK(outcomes(c.ear, other, presentation_t::DROPPED_BY_PROFILE) == 0);
  // A commanded gap is no loss: the node itself is well.
  CHECK(c.all_live(kNodes));
  for (const auto& [node, rate] : c.rates(2)) {
    INFO(node);
    CHECK(rate > before.at(node) / 2);
  }

  degrade(c, "off");
  const int heard = outcomes(c.ear, "audio", presentation_t::PRESENTED);
  CHECK(
      c.ear.wait_until([&] { return outcomes(c.ear, "audio", presentation_t::PRESENTED) > heard; }, kPatience_s));
}
