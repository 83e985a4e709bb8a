// The SDF file of a scene and all files that it includes: located, checked against limits and parsed, before a tree of
// elements is made of them (tree.h).
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "sim_node/scene/sdf/element.h"
#include "sync/sandbox/readable_folders.h"

namespace tinyxml2 {
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace tactus::sim {

// Elements of a scene with all its includes. More than any scene has (design): 30,000 bodies have 500,000. They bound
// files that include each other several times: ten files of 500 bytes that each include the next one ten times have
// 10^10 models.
constexpr std::size_t kMaxSceneElements = 2'500'000, kMaxCopiedElements = 1'000'000;
// Levels of elements with their includes; functions call themselves for each level.
constexpr int kMaxSceneDepth = 100;

class SdfFiles {
 public:
  // Reads `file` and all its includes. folders: searched and readable besides the folder of `file`. Counts the elements of
  // the expanded scene. Throws std::runtime_error with one sentence and its line.
  SdfFiles(const std::filesystem::path& file, std::vector<std::string>& warnings,
           const std::vector<std::filesystem::path>& folders = {});
  ~SdfFiles();
  SdfFiles(const SdfFiles&) = delete;
  SdfFiles& operator=(const SdfFiles&) = delete;

  struct Skipped {
    std::string uri;
    int line = 0;
  };
  struct Document {
    sdf::Source source;
    std::unique_ptr<tinyxml2::XMLDocument> xml;
    // With all includes: elements, those of repeated copies of files among them, and levels.
    std::size_t elements = 0, copies = 0;
    int depth = 0;
  };

  const std::string& main_text() const { return text_; }
  const Document& main() const;
  // The file that an <include> names; nullptr: it is not read (skipped()).
  const Document* included_by(const tinyxml2::XMLElement& include) const;
  // Includes that are not read: remote files, and the two models of every Gazebo installation.
  const std::vector<Skipped>& skipped() const { return skipped_; }

  // Finds a file that an element names (a mesh, an image); an empty path when it does not exist. It may lie outside the
  // readable folders.
  std::filesystem::path find(const std::string& uri, const std::filesystem::path& from_file) const;
  // The folder of the scene and those that the user named: no file of the scene is read elsewhere.
  const sync::ReadableFolders& readable() const { return readable_; }
  // The end of the sentence for a file outside them.
  static constexpr const char* kOutside =
      "is hidden or outside the folder of the scene: put it beside the scene, or name its folder with --scene-folder";
  // The file as the user named it.
  std::string shown(const std::filesystem::path& file) const;

 private:
  struct Size {
    std::size_t elements = 0, copies = 0;
    int depth = 0;
  };

  // from: "FILE:LINE" of the include. chain: the files that include each other down to this one.
  const Document& scan(const std::filesystem::path& file, const std::string& from,
                       std::vector<std::filesystem::path>& chain);
  void parse(Document& document, const std::string& included_by);
  void count(Document& document, int line, const Size& more) const;
  void follow(const tinyxml2::XMLElement& include, Document& document, int depth,
              std::vector<std::filesystem::path>& chain);
  // nullptr with a warning: the include is skipped.
  const Document* document_of(const tinyxml2::XMLElement& include, const std::string& uri, const Document& from,
                              std::vector<std::filesystem::path>& chain);
  void check_version(sdf::Source& source, const tinyxml2::XMLElement& root);

  std::vector<std::string>& warnings_;
  std::filesystem::path shown_folder_, main_;
  std::string text_;
  std::unordered_map<std::string, Document> documents_;                           // by path
  std::unordered_map<const tinyxml2::XMLElement*, const Document*> included_;  // by <include>
  std::unordered_map<std::string, std::filesystem::path> file_of_folder_;         // named by model.config
  std::vector<std::filesystem::path> named_;
  sync::ReadableFolders readable_;
  std::vector<Skipped> skipped_;
  int includes_ = 0;
  std::uintmax_t bytes_ = 0;  // of all files
  std::size_t parts_ = 0;     // of all files (xml_scan.h)
};

}  // namespace tactus::sim
