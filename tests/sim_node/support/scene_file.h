// A scene written into its own temporary folder for one test, and the loader's result.
#pragma once

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim_node/scene/load_sdf.h"

namespace tactus::sim {

class SceneFile {
 public:
  using Files = std::vector<std::pair<std::string, std::vector<std::uint8_t>>>;

  // beside: files in the same folder, by name.
  explicit SceneFile(const std::string& text = "", const Files& beside = {}) {
    std::string name = (std::filesystem::temp_directory_path() / "tactus_scene_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    folder_ = name;
    if (!text.empty()) write("scene.sdf", text);
    for (const auto& [file, bytes] : beside) write(file, {bytes.begin(), bytes.end()});
  }
  ~SceneFile() { std::filesystem::remove_all(folder_); }
  SceneFile(const SceneFile&) = delete;
  SceneFile& operator=(const SceneFile&) = delete;

  const std::filesystem::path& folder() const { return folder_; }
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  WorldDef load() {
    warnings.clear();
    return load_sdf(folder_ / "scene.sdf", warnings);
  }
  // The sentence that rejects the scene, without the folder; empty when it loads.
  std::string load_error() {
    try {
      load();
      return "";
    } catch (const std::runtime_error& e) {
      return short_form(e.what());
    }
  }
  // Without the folder.
  std::vector<std::string> short_warnings() const {
    std::vector<std::string> result;
    for (const std::string& w : warnings) result.push_back(short_form(w));
    return result;
  }

  std::vector<std::string> warnings;

 private:
  std::string short_form(std::string text) const {
    const std::string prefix = folder_.string() + "/";
    for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) text.erase(at, prefix.size());
    return text;
  }
  std::filesystem::path folder_;
};

// `inside` begins on line 3.
inline std::string world(const std::string& inside, const std::string& version = "1.9") {
  return "<sdf version=\"" + version + "\" xmlns:tactus=\"https://tactus.dev/sdf\">\n<world name=\"w\">\n" + inside +
         "\n</world>\n</sdf>\n";
}
inline std::string model(const std::string& inside) { return world("<model name=\"m\">\n" + inside + "\n</model>"); }
// One link; `inside` begins on line 5.
inline std::string link(const std::string& inside) { return model("<link name=\"l\">\n" + inside + "\n</link>"); }
inline std::string collision(const std::string& geometry) {
  return "<collision name=\"c\"><geometry>" + geometry + "</geometry></collision>";
}

}  // namespace tactus::sim
