// The SDF file of a scene and all files that it includes, located and checked before libsdformat reads them.
// libsdformat searches the working directory for includes, overflows its stack on a cycle, and prints errors of
// included files instead of returning them.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <sdf/Element.hh>

#include "sync/sandbox/readable_folders.h"

namespace tinyxml2 {
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace tactus::sim {

class SdfFiles {
 public:
  // Reads `file` and all its includes. folders: searched and readable besides the folder of `file`. Counts the elements of
  // the expanded scene before libsdformat allocates them. Throws std::runtime_error with one sentence and its line.
  SdfFiles(const std::filesystem::path& file, std::vector<std::string>& warnings,
           const std::vector<std::filesystem::path>& folders = {});
  ~SdfFiles();

  struct Skipped {
    std::string uri;
    int line = 0;
  };

  const std::filesystem::path& main_file() const { return main_; }
  const std::string& main_text() const { return text_; }
  // The included files, each once, deepest first.
  const std::vector<std::filesystem::path>& included() const { return included_; }
  // Search folders of libsdformat for includes.
  const std::vector<std::filesystem::path>& folders() const { return folders_; }
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
  // "FILE:LINE", with the file as the user named it. Elements unknown to libsdformat carry no line; this function
  // finds it.
  std::string where(const sdf::Element& element) const;
  std::string where(const std::string& file, int line) const;

 private:
  // With all includes: the memory that libsdformat takes for the elements, the part of it for repeated copies of files,
  // and the number of levels.
  struct Size {
    std::size_t all_kB = 0, copies_kB = 0;
    int depth = 0;
  };

  // from: "FILE:LINE" of the include. chain: the files that include each other down to this one.
  void scan(const std::filesystem::path& file, const std::string& from, std::vector<std::filesystem::path>& chain);
  void parse(const std::filesystem::path& file, const std::string& included_by, tinyxml2::XMLDocument& document);
  void add_search_folders(const std::filesystem::path& file);
  void count(const std::filesystem::path& file, const tinyxml2::XMLElement& at, const Size& more);
  void follow(const tinyxml2::XMLElement& include, const std::filesystem::path& file, int depth,
              std::vector<std::filesystem::path>& chain);
  void check_version(const tinyxml2::XMLElement& root, const std::string& here);
  const tinyxml2::XMLElement* in_file(const sdf::Element& element) const;

  std::vector<std::string>& warnings_;
  std::filesystem::path shown_folder_;
  std::filesystem::path main_;
  std::string text_;
  std::map<std::filesystem::path, std::unique_ptr<tinyxml2::XMLDocument>> documents_;
  std::map<std::filesystem::path, Size> sizes_;
  std::vector<std::filesystem::path> included_, folders_, named_;
  sync::ReadableFolders readable_;
  std::vector<Skipped> skipped_;
  int includes_ = 0;
  std::uintmax_t bytes_ = 0;  // of all files
};

}  // namespace tactus::sim
