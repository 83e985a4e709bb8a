// Tests of a contact of 3 ms, which is over before the next video frame and the next thermal tick: no degradation of one modality makes
// another modality miss it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/cluster/support/run_script.h"

using namespace tactus::cluster;

namespace {

// Playout policies under test, as options of scripts/run; "": its default. Each policy is tested with one degraded modality. With
// TACTUS_ALL_POLICIES in the environment, which takes five minutes, each policy is tested with all of them.
const std::map<std::string, std::string> kPolicy{
    {"", ""}, {"audio", "asap"}, {"visual", "experiment"}, {"haptic", "itouch2005"}, {"thermal", "aligned"}};

std::vector<std::string> policies_for(const std::string& degraded) {
  if (std::getenv("TACTUS_ALL_POLICIES")) return {"", "asap", "aligned", "experiment", "itouch2005"};
  return {kPolicy.at(degraded)};
}

const std::map<std::string, std::vector<std::string>> kExpectedKinds{
    {"haptic", {"begin", "hit"}}, {"audio", {"hit"}}, {"visual", {"begin", "hit"}}, {"thermal", {"begin", "hit"}}};

// The tool dips 0.6 mm into the floor and out of it at 0.5 m/s: 3 ms from touch to the published end, at a gap of 0.3 mm. 257 ms between
// two dips, which is not a multiple of the period of any modality.
std::filesystem::path write_motion(const std::filesystem::path& file) {
  constexpr double kRadius_m = 0.008, kDip_m = 0.0006, kSpeed_m_s = 0.5, kAbove_m = 0.03;
  std::ofstream out(file);
  out << "time_s,x_m,y_m,z_m\n0,0,0," << kAbove_m << "\n";
  for (double dip_s = 1; dip_s < 60; dip_s += 0.257) {
    out << dip_s - 0.03 << ",0,0," << kAbove_m << "\n";
    for (int ms = -12; ms <= 12; ++ms)
      out << dip_s + ms * 0.001 << ",0,0," << kRadius_m - kDip_m + std::abs(ms) * 0.001 * kSpeed_m_s << "\n";
    out << dip_s + 0.03 << ",0,0," << kAbove_m << "\n";
  }
  return file;
}

std::vector<std::map<std::string, std::string>> table(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::map<std::string, std::string>> rows;
  std::vector<std::string> names;
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    std::map<std::string, std::string> row;
    std::size_t i = 0;
    for (std::string cell; std::getline(cells, cell, ','); ++i) {
      if (rows.empty() && row.empty() && names.size() == i)
        names.push_back(cell);
      else if (i < names.size())
        row[names[i]] = cell;
    }
    if (!row.empty()) rows.push_back(row);
  }
  return rows;
}

struct Result {
  std::map<std::string, std::string> kind;                            // kind of each settled event, by id
  std::map<std::string, std::map<std::string, std::string>> outcome;  // by modality and event
  std::map<std::string, double> min_latency_ms;                           // after the event, by modality
  std::vector<double> durations_ms;                                      // durations of the contacts
};

Result read(const std::filesystem::path& out) {
  Result r;
  const auto events = table(out / "events.csv");
  REQUIRE_FALSE(events.empty());
  const auto ns = [](const auto& row, const char* name) { return std::stoll(row.at(name)); };
  std::map<std::string, std::int64_t> began, event_ns;
  std::map<std::string, std::string> kind_of;
  // Events of the last 1.2 s may be unreported when the run ends.
  const std::int64_t settled = ns(events.back(), "host_ns") - 1'200'000'000;
  for (const auto& row : events) {
    event_ns[row.at("event_id")] = ns(row, "host_ns");
    kind_of[row.at("event_id")] = row.at("kind");
    if (row.at("kind") == "begin") began[row.at("contact_id")] = ns(row, "sim_ns");
    if (row.at("kind") == "end" && began.contains(row.at("contact_id")))
      r.durations_ms.push_back(static_cast<double>(ns(row, "sim_ns") - began.at(row.at("contact_id"))) * 1e-6);
    if (ns(row, "host_ns") < settled) r.kind[row.at("event_id")] = row.at("kind");
  }
  for (const auto& row : table(out / "presented.csv")) {
    r.outcome[row.at("modality")][row.at("event_id")] = row.at("outcome");
    if (ns(row, "presented_ns") < 0 || !event_ns.contains(row.at("event_id"))) continue;
    // A fixed surface is felt when the hand reaches it, however late its report.
    if (row.at("modality") == "haptic" && kind_of.at(row.at("event_id")) == "begin") continue;
    const double after_ms =
        static_cast<double>(ns(row, "presented_ns") - event_ns.at(row.at("event_id"))) * 1e-6;
    const auto [min_latency, inserted] = r.min_latency_ms.try_emplace(row.at("modality"), after_ms);
    min_latency->second = std::min(min_latency->second, after_ms);
  }
  return r;
}

void check_presentations(const std::string& degraded) {
  for (const std::string& policy : policies_for(degraded)) {
    RunScript run;
    const std::filesystem::path profile = run.folder.path() / "profile.xml";
    std::ofstream(profile) << "<profile name=\"slow\"><degrade modality=\"" << degraded
                           << "\" rate=\"5Hz\" delay=\"30ms\"/></profile>";
    std::vector<std::string> options{
        (repository() / "tests/cluster/scenes/short_contacts.sdf").string(),          "--seconds", "7",      "--device",
        "playback:" + write_motion(run.folder.path() / "motion.csv").string(), "--out",     run.out()};
    // A busy machine delays a presentation but must not lose it.
    for (const char* limit : {"visual_node.drop_after=10", "haptic_node.drop_after=1", "audio_node.late_limit=0.5"})
      options.insert(options.end(), {"--set", limit});
    if (!degraded.empty()) options.insert(options.end(), {"--degrade", profile});
    if (!policy.empty()) options.insert(options.end(), {"--policy", policy});
    run.start(options);
    const int status = run.finish(150);
    INFO("policy \"" << policy << "\": " << run.processes.output("run"));
    REQUIRE(status == 0);

    Result r = read(run.out());
    REQUIRE(r.durations_ms.size() >= 10);
    std::sort(r.durations_ms.begin(), r.durations_ms.end());
    CHECK(r.durations_ms[r.durations_ms.size() / 2] == Approx(3).margin(1.5));
    for (const auto& [sense, kinds] : kExpectedKinds) {
      int expected = 0, presented = 0, refused = 0;
      std::map<std::string, int> outcomes;
      for (const auto& [id, kind] : r.kind) {
        if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) continue;
        ++expected;
        const auto& reports = r.outcome[sense];
        const std::string outcome = reports.contains(id) ? reports.at(id) : "nothing";
        ++outcomes[outcome];
        presented += outcome == "presented" || outcome == "late";
        refused += outcome == "dropped_by_profile" || outcome == "dropped_late";
      }
      std::ostringstream output;
      for (const auto& [outcome, n] : outcomes) output << n << " " << outcome << ", ";
      INFO(sense << " of " << expected << ": " << output.str());
      CHECK(expected >= 10);
      // The profile takes effect on its modality: 30 ms, less half a video frame, because a picture shows the nearest event.
      if (sense == degraded && r.min_latency_ms.contains(sense)) CHECK(r.min_latency_ms.at(sense) > 21);
      // A rate limit may delay an event too far for the degraded modality, which then reports a refusal. In the serial loop touch renders
      // only contacts that exist in its own slot.
      const bool may_refuse = sense == degraded || (policy == "itouch2005" && sense == "haptic");
      CHECK(presented + (may_refuse ? refused : 0) == expected);
    }
  }
}

}  // namespace

TEST_CASE("A 3 ms contact between two video frames flashes, sounds and warms, without degradation") {
  check_presentations("");
}
TEST_CASE("A 3 ms contact between two video frames flashes, warms and is felt, with degraded sound") {
  check_presentations("audio");
}
TEST_CASE("A 3 ms contact between two video frames sounds, warms and is felt, with degraded vision") {
  check_presentations("visual");
}
TEST_CASE("A 3 ms contact between two video frames flashes, sounds and warms, with degraded touch") {
  check_presentations("haptic");
}
TEST_CASE("A 3 ms contact between two video frames flashes, sounds and is felt, with degraded warmth") {
  check_presentations("thermal");
}
