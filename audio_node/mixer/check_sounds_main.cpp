// check_sounds: lists the contents of a folder of recordings, its faults, and the fallbacks for contacts of given
// materials. tactus check-sounds calls it.
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "audio_node/samples/database.h"
#include "audio_node/mixer/library.h"
#include "sync/node/node_options.h"

using namespace tactus;
using namespace tactus::audio;

namespace {

std::string pair_name(const MaterialPair& m) { return m.first.empty() ? m.second : m.first + "-" + m.second; }

nlohmann::json contents(const Database& database) {
  nlohmann::json all = nlohmann::json::array();
  for (const auto& [key, layers] : database.sounds) {
    nlohmann::json row{
        {"materials", pair_name(key.materials)}, {"interaction", name(key.interaction)}, {"size_m", layers.size_m}};
    for (const Layer& layer : layers.by_speed)
      row["layers"].push_back({{"speed_m_s", layer.speed_m_s}, {"takes", layer.takes.size()}});
    all.push_back(row);
  }
  return all;
}

// Sound source for each pair of the materials.
nlohmann::json coverage(const Database& database, const std::vector<std::string>& materials) {
  nlohmann::json all = nlohmann::json::array();
  for (std::size_t i = 0; i < materials.size(); ++i)
    for (std::size_t k = i; k < materials.size(); ++k)
      for (const Interaction interaction : kInteractions) {
        const auto found = database.find(materials[i], materials[k], interaction);
        std::string plays = found.pair ? "pair" : found.alone[0] ? materials[i] : "";
        if (found.alone[1]) plays += (plays.empty() ? "" : " and ") + materials[k];
        all.push_back({{"materials", pair_name(pair_of(materials[i], materials[k]))},
                       {"interaction", name(interaction)},
                       {"plays", plays.empty() ? "modal" : plays}});
      }
  return all;
}

void print(const nlohmann::json& report) {
  std::printf("%-24s %-8s %8s  %s\n", "materials", "", "size m", "speeds in m/s (takes)");
  for (const auto& row : report["sounds"]) {
    std::printf("%-24s %-8s %8.3f ", row["materials"].get<std::string>().c_str(),
                row["interaction"].get<std::string>().c_str(), row["size_m"].get<double>());
    for (const auto& layer : row["layers"])
      std::printf(" %g (%d)", layer["speed_m_s"].get<double>(), layer["takes"].get<int>());
    std::printf("\n");
  }
  if (!report["pairs"].empty()) std::printf("\nPairs of the materials of the scene, and the source of their sound:\n");
  std::string last;
  for (const auto& row : report["pairs"]) {
    const auto pair = row["materials"].get<std::string>();
    if (pair != last) std::printf("%s%-24s", last.empty() ? "" : "\n", pair.c_str());
    last = pair;
    std::printf(" %s: %-18s", row["interaction"].get<std::string>().c_str(),
                row["plays"].get<std::string>().c_str());
  }
  if (!last.empty()) std::printf("\n");
  for (const auto& fault : report["faults"])
    std::printf("%s%s %s\n", &fault == &report["faults"].front() ? "\n" : "",
                fault["path"].get<std::string>().c_str(), fault["what"].get<std::string>().c_str());
}

}  // namespace

int main(int argc, char** argv) try {
  std::string folder = "default";
  std::vector<std::string> materials;
  bool json = false;
  double rate_Hz = 48000;
  sync::Arguments app{"Lists the contents of a folder of recordings, its faults, and its gaps."};
  app.add_option("folder", folder, "folder of recordings; default: the set beside this program");
  app.add_option("--materials", materials, "materials; prints the source of sound of each pair").delimiter(',');
  app.add_option("--rate", rate_Hz, "sample rate of the sound card, Hz").range(8000.0, 192000.0);
  app.add_flag("--json", json, "print it as JSON");
  sync::parse_or_exit(app, "check_sounds", argc, argv);
  std::sort(materials.begin(), materials.end());
  materials.erase(std::unique(materials.begin(), materials.end()), materials.end());
  const Database database = read_database(sounds_folder(folder), rate_Hz, Settings{}.recorded_size_m);
  nlohmann::json report{{"folder", sounds_folder(folder)},
                        {"sounds", contents(database)},
                        {"pairs", coverage(database, materials)},
                        {"megabytes", static_cast<double>(database.bytes) / 1e6}};
  report["faults"] = nlohmann::json::array();
  for (const SoundFault& f : database.faults)
    report["faults"].push_back({{"path", f.path}, {"what", f.what}, {"played", !f.unusable}});
  if (json)
    std::cout << report.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
  else
    print(report);
  return database.faults.empty() ? 0 : 1;
} catch (const std::exception& e) {
  return sync::fail("check_sounds", e);
}
