// The folders from which files that an untrusted file names may be read.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace tactus::sync {

class ReadableFolders {
 public:
  // Folders that do not exist are left out. Symbolic links in their paths are resolved.
  explicit ReadableFolders(const std::vector<std::filesystem::path>& folders);

  // The path with all symbolic links resolved, when it lies below one of the folders and no part of it below that folder
  // is hidden (begins with a dot): "..", absolute paths and links cannot leave the folders. nullopt: outside, hidden or
  // missing.
  std::optional<std::filesystem::path> resolve(const std::filesystem::path& file) const;

  // Canonical.
  const std::vector<std::filesystem::path>& folders() const { return folders_; }

 private:
  std::vector<std::filesystem::path> folders_;
};

}  // namespace tactus::sync
