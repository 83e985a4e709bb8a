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

namespace tinyxml2 {
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace tactus::sim {

class SdfFiles {
 public:
  // Reads `file` and all its includes. Throws std::runtime_error with one sentence and its line.
  SdfFiles(const std::filesystem::path& file, std::vector<std::string>& warnings);
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

  // Finds a file that an element names (a mesh, an image); an empty path when it does not exist.
  std::filesystem::path find(const std::string& uri, const std::filesystem::path& from_file) const;
  // "FILE:LINE", with the file as the user named it. Elements unknown to libsdformat carry no line; this function
  // finds it.
  std::string where(const sdf::Element& element) const;
  std::string where(const std::string& file, int line) const;

 private:
  void scan(const std::filesystem::path& file, const std::string& from, std::vector<std::filesystem::path> chain);
  void follow(const tinyxml2::XMLElement& include, const std::filesystem::path& file,
              const std::vector<std::filesystem::path>& chain);
  void check_version(const tinyxml2::XMLElement& root, const std::string& here);
  const tinyxml2::XMLElement* in_file(const sdf::Element& element) const;

  std::vector<std::string>& warnings_;
  std::filesystem::path shown_folder_;
  std::filesystem::path main_;
  std::string text_;
  std::map<std::filesystem::path, std::unique_ptr<tinyxml2::XMLDocument>> documents_;
  std::vector<std::filesystem::path> included_, folders_;
  std::vector<Skipped> skipped_;
  int includes_ = 0;
};

}  // namespace tactus::sim
